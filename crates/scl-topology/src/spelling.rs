//! How names are spelt.

/// Whether a name without a group follows the rules of spelling, so that the rules about its meaning can check it.
pub(crate) fn is_well_formed(name: &str) -> bool {
    name.chars().all(is_allowed) && !name.contains("--") && name.starts_with(may_start)
}

/// Whether this can be the name of a component or group, perhaps in groups.
pub(crate) fn is_well_formed_in_groups(name: &str) -> bool {
    name.split('.').all(is_well_formed)
}

/// Whether it is a word of ASCII letters, digits and `_` that does not start with a digit.
pub(crate) fn is_word(word: &str) -> bool {
    word.starts_with(may_start) && word.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}

pub(crate) fn is_allowed(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_' || letter == '-'
}

pub(crate) fn may_start(letter: char) -> bool {
    letter.is_ascii_alphabetic() || letter == '_'
}
