//! A YAML text as values that know their places, whatever kind of file it is.

use super::dialect::Dialect;
use super::{pitfall, syntax_error};
use crate::diagnostic::Diagnostics;
use crate::source::SourceFile;
use crate::yaml::{self, Node, Tree};

/// What could be read of a YAML text.
#[derive(Debug, Default)]
pub struct Document {
    /// The value of the file; none if there is none.
    pub root: Option<Node>,
    /// A part of the text could not be read, so what seems to be missing may be in it.
    pub is_partial: bool,
}

impl Document {
    pub(super) fn of(tree: Tree) -> Self {
        Self { is_partial: tree.is_partial(), root: tree.root }
    }
}

/// Reads a YAML file of any kind, and reports what is wrong with the text itself: all of `SCL01xx` that does not depend on
/// what the values mean.
///
/// Takes linear time and does not panic, whatever the text.
pub fn read_document(source: &SourceFile, dialect: &Dialect, problems: &mut Diagnostics) -> Document {
    let text = pitfall::check_text(source, dialect, problems);
    let tree = yaml::read(&text.text, source.id(), dialect.has_aliases);
    pitfall::check_tree(&tree, source, dialect, problems);
    problems.extend(syntax_error::explain(&tree, &text, source, dialect));
    let mut document = Document::of(tree);
    document.is_partial |= text.has_conflict;
    document
}
