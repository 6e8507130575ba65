//! The names of a file, and what each of them names.

use crate::model::Model;
use crate::source::Spanned;

/// What a name names, as messages say it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Noun {
    System,
    Component,
    Gate,
}

impl Noun {
    pub(super) fn word(self) -> &'static str {
        match self {
            Noun::System => "system",
            Noun::Component => "component",
            Noun::Gate => "gate",
        }
    }
}

/// Every name that the file declares.
pub(super) fn names(model: &Model) -> impl Iterator<Item = (Noun, &Spanned<String>)> {
    let system = model.system.iter().map(|name| (Noun::System, name));
    let declared = model.components.iter().flat_map(|component| {
        let gates = component.gates.iter().map(|gate| (Noun::Gate, &gate.name));
        std::iter::once((Noun::Component, &component.name)).chain(gates)
    });
    system.chain(declared)
}

/// Whether the rules of spelling hold, so that the rules of meaning may look at the name.
pub(super) fn is_well_formed(name: &str) -> bool {
    name.chars().all(is_allowed) && !name.contains("--") && name.starts_with(may_start)
}

pub(super) fn is_allowed(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_' || letter == '-'
}

pub(super) fn may_start(letter: char) -> bool {
    letter.is_ascii_alphabetic() || letter == '_'
}
