//! The names of a file, and what each of them names.

use crate::model::Model;
use crate::source::Spanned;
use crate::spelling::is_well_formed;
use std::collections::HashMap;
use std::hash::Hash;

/// A name and its place.
pub(super) type Name = Spanned<String>;

/// The longest name of a component or gate, in characters.
pub(super) const LONGEST_NAME: usize = 64;

/// What a name stands for, in the words of messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Noun {
    System,
    Kind,
    Component,
    Gate,
    Parameter,
}

impl Noun {
    pub(super) fn word(self) -> &'static str {
        match self {
            Noun::System => "system",
            Noun::Kind => "kind",
            Noun::Component => "component",
            Noun::Gate => "gate",
            Noun::Parameter => "parameter",
        }
    }

    /// Whether a name follows the rules of spelling.
    pub(super) fn is_well_formed(self, name: &str) -> bool {
        self.words(name).all(is_well_formed)
    }

    /// The names of the groups and the own name that a full name consists of.
    pub(super) fn words(self, name: &str) -> impl Iterator<Item = &str> {
        name.split(move |letter| letter == '.' && self.may_have_group())
    }

    /// Whether the name may contain those of groups: `left_arm.planner`.
    pub(super) fn may_have_group(self) -> bool {
        self.is_type()
    }

    /// Whether the name becomes that of a type.
    pub(super) fn is_type(self) -> bool {
        matches!(self, Noun::Kind | Noun::Component)
    }
}

/// Every name that the file declares.
pub(super) fn names(model: &Model) -> impl Iterator<Item = (Noun, &Name)> {
    let system = model.system.iter().map(|name| (Noun::System, name));
    let gates = model.owners().flat_map(|owner| &owner.gates).map(|gate| (Noun::Gate, &gate.name));
    let parameters = model.owners().flat_map(|owner| &owner.parameters).map(|it| (Noun::Parameter, &it.name));
    system.chain(types(model)).chain(gates).chain(parameters)
}

/// The names that become types.
pub(super) fn types(model: &Model) -> impl DoubleEndedIterator<Item = (Noun, &Name)> {
    let kinds = model.kinds.iter().map(|kind| (Noun::Kind, &kind.name));
    kinds.chain(model.components.iter().map(|component| (Noun::Component, &component.name)))
}

/// Each name with the first one that has the same key, which may be itself.
pub(super) fn with_first<'m, K: Eq + Hash>(
    names: impl Iterator<Item = &'m Name>,
    key: impl Fn(&'m str) -> K,
) -> impl Iterator<Item = (&'m Name, &'m Name)> {
    let mut first = HashMap::new();
    names.map(move |name| (*first.entry(key(&name.value)).or_insert(name), name))
}
