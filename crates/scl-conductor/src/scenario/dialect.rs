//! What the rules about YAML need to know about scenarios.

use super::rules::keys;
use scl_topology::parse::Dialect;

pub(super) static SCENARIO: Dialect = Dialect {
    noun: "scenario",
    minimal: "until: 1min",
    levels: 4,
    has_aliases: true,
    instead_of_merge: "write it out, or use an alias for a whole value",
    is_key: |word| keys().any(|key| key == word),
    word: |word| keys().find(|key| *key == word),
    mistakes: |_, _| 0,
};
