//! The two lists whose items have the same shape: components, and kinds of components.

use super::words::{COMPONENT_KEYS, KIND_KEYS};

/// What an item of the list declares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Entry {
    Component,
    Kind,
}

impl Entry {
    /// What messages call it.
    pub(super) fn word(self) -> &'static str {
        match self {
            Entry::Component => "component",
            Entry::Kind => "kind",
        }
    }

    /// The list that it is in.
    pub(super) fn section(self) -> &'static str {
        match self {
            Entry::Component => "components",
            Entry::Kind => "kinds",
        }
    }

    /// What messages call its name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Entry::Component => "component name",
            Entry::Kind => "kind name",
        }
    }

    /// Its keys.
    pub(super) fn keys(self) -> &'static [&'static str] {
        match self {
            Entry::Component => &COMPONENT_KEYS,
            Entry::Kind => &KIND_KEYS,
        }
    }
}
