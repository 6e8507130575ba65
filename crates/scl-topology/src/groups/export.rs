//! The gates of a group that can be connected from outside.

use crate::source::Span;
use std::collections::HashMap;

/// What a group exports, by the names for the outside.
pub(super) type Exports = HashMap<String, Export>;

/// A gate that a group exports.
#[derive(Clone)]
pub(super) struct Export {
    /// The place of its name for the outside.
    pub(super) at: Span,
    /// The full name of the gate.
    pub(super) gate: String,
    /// No component of the file has it. This is reported there.
    pub(super) is_unknown: bool,
}
