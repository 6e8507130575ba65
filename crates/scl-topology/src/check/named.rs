//! The names of a file, and what each of them names.

use crate::model::Model;
use crate::source::Spanned;
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
pub(super) fn names(model: &Model) -> impl Iterator<Item = (Noun, &Name)> {
    let system = model.system.iter().map(|name| (Noun::System, name));
    let declared = model.components.iter().flat_map(|component| {
        let gates = component.gates.iter().map(|gate| (Noun::Gate, &gate.name));
        std::iter::once((Noun::Component, &component.name)).chain(gates)
    });
    system.chain(declared)
}

/// Whether a name follows the rules of spelling, so that the rules about its meaning can check it.
pub(super) fn is_well_formed(name: &str) -> bool {
    name.chars().all(is_allowed) && !name.contains("--") && name.starts_with(may_start)
}

/// Whether it is a word of ASCII letters, digits and `_` that does not start with a digit.
pub(super) fn is_word(word: &str) -> bool {
    word.starts_with(may_start) && word.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}

/// Each name with the first one that has the same key, which may be itself.
pub(super) fn with_first<'m, K: Eq + Hash>(
    names: impl Iterator<Item = &'m Name>,
    key: impl Fn(&'m str) -> K,
) -> impl Iterator<Item = (&'m Name, &'m Name)> {
    let mut first = HashMap::new();
    names.map(move |name| (*first.entry(key(&name.value)).or_insert(name), name))
}

pub(super) fn is_allowed(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_' || letter == '-'
}

pub(super) fn may_start(letter: char) -> bool {
    letter.is_ascii_alphabetic() || letter == '_'
}
