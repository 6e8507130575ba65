//! A YAML text as values that know their places, whatever kind of file it is.

use crate::yaml::{Node, Tree};

/// What could be read of a YAML text.
#[derive(Debug, Default)]
pub struct Document {
    /// The value of the file; `None` if it has none.
    pub root: Option<Node>,
    /// A part of the text could not be read, so what seems to be missing may be in it.
    pub is_partial: bool,
}

impl Document {
    pub(super) fn of(tree: Tree) -> Self {
        Self { is_partial: tree.is_partial(), root: tree.root }
    }
}
