//! Which words the format knows, and as what.

use crate::grammar::{self, GateKind, OPTIONS, option};
use crate::suggest::{self, similar};

/// The sections of a topology, in the order in which messages list them.
pub(super) const SECTIONS: [&str; grammar::SECTIONS.len()] = grammar::words(&grammar::SECTIONS);

/// The keys of a component, in the order in which messages list them.
pub(super) const COMPONENT_KEYS: [&str; grammar::COMPONENT_KEYS.len()] = grammar::words(&grammar::COMPONENT_KEYS);

/// The keys of a kind of components, in the order in which messages list them.
pub(super) const KIND_KEYS: [&str; COMPONENT_KEYS.len() - 1] = {
    let [keys @ .., _kind] = COMPONENT_KEYS;
    keys
};

/// Returns the key, kind or option of this name, if the format knows one.
pub(super) fn known_word(word: &str) -> Option<&'static str> {
    let keys = grammar::SECTIONS.iter().chain(&grammar::COMPONENT_KEYS).map(|key| key.key);
    let kinds = GateKind::ALL.into_iter().map(GateKind::word);
    let options = OPTIONS.iter().map(|option| option.key);
    keys.chain(kinds).chain(options).find(|known| *known == word)
}

/// Whether this key is the kind of a gate.
pub(super) fn is_kind(word: &str) -> bool {
    GateKind::of(word).is_some()
}

/// Whether this key is an option of some gate.
pub(super) fn is_option(key: &str) -> bool {
    option(key).is_some()
}

/// Whether this key is an option, or looks more like one than like a kind.
pub(super) fn is_like_option(key: &str) -> bool {
    let kinds = GateKind::ALL.map(GateKind::word);
    let is_called = || crate::habits::GATE.find(key).is_some_and(|habit| !habit.ways.is_empty());
    is_option(key)
        || suggest::kind(key).is_empty() && is_called()
        || similar(key, kinds).is_empty() && !similar(key, OPTIONS.iter().map(|option| option.key)).is_empty()
}

#[cfg(test)]
mod tests {
    use super::is_like_option;

    #[test]
    fn a_misspelt_kind_is_no_option() {
        for (key, like) in [("queue", true), ("que", true), ("publ", false), ("publish", false), ("reqq", false)] {
            assert_eq!(is_like_option(key), like, "{key}");
        }
    }
}
