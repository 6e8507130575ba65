//! A mistake in a schema file that the schema compiler does not find or does not explain.

use std::ops::Range;
use std::path::PathBuf;

/// What is wrong, where in the file's text, and what to do.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Mistake {
    /// The file as the topology file would name it.
    pub(super) file: String,
    pub(super) at: Range<usize>,
    pub(super) message: String,
    pub(super) label: String,
    pub(super) help: Option<String>,
    /// The folder that should be one of the `schema_roots`.
    pub(super) root: Option<PathBuf>,
    pub(super) note: Option<String>,
    /// The name that the mistake is about, if all mistakes about it are one.
    pub(super) subject: Option<String>,
    /// It follows from a wrong entry of `schemas`, which is reported.
    pub(super) follows: bool,
}
