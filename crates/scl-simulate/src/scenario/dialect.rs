//! What the rules about YAML need to know about scenarios.

use super::rules::KEYS;
use scl_topology::parse::Dialect;

pub(super) static SCENARIO: Dialect = Dialect {
    noun: "scenario",
    minimal: "until: 1min",
    levels: 4,
    has_aliases: true,
    instead_of_merge: "write it out, or use an alias for a whole value",
    is_key: |word| KEYS.contains(&word),
    word: |word| KEYS.iter().find(|known| **known == word).copied(),
    mistakes: |_, _| 0,
};
