//! A mistake in a schema file that the schema compiler does not find or does not explain.

use std::ops::Range;

/// What is wrong, where in the file's text, and what to do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Mistake {
    /// The file as the topology file would name it.
    pub(super) file: String,
    pub(super) at: Range<usize>,
    pub(super) message: String,
    pub(super) label: String,
    pub(super) help: Option<String>,
    pub(super) note: Option<String>,
}
