//! Groups: a file that is included `as: left_arm` becomes a group. Its components get the names `left_arm.planner`, and
//! only the gates that it exports can be connected from outside.
//!
//! This runs before kinds and `everyone` are written out. The components of a file that becomes several groups become
//! kinds, so that one program can run them.

mod ends;
mod except;
mod export;
mod flat;
mod lift;
mod rules;

pub use flat::flatten;
pub(crate) use rules::{BAD_ENTRY, BAD_EXPORT, RULES, TAKEN, UNKNOWN_EXPORT};

use crate::model::Model;
use crate::source::{FileId, Spanned};
use std::sync::Arc;

/// The files of a system or of a group, joined, with the groups in them.
#[derive(Debug, Clone, Default)]
pub struct Scope {
    /// What the files declare. Names are those in the files.
    pub model: Model,
    /// The files that become groups.
    pub groups: Vec<Group>,
}

/// A file that becomes a group.
#[derive(Debug, Clone)]
pub struct Group {
    /// `as:`.
    pub name: Spanned<String>,
    /// The file.
    pub file: FileId,
    /// The file's name without its extension, which stands before the names of kinds.
    pub stem: String,
    /// What it contains. All groups of a file share it.
    pub scope: Arc<Scope>,
}
