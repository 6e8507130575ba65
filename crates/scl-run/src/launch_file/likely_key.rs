//! An unknown key, and the one that it probably means.

use super::habits::Habit;
use super::keys::{Key, is_called};
use super::rules::UNKNOWN_KEY;
use super::words::{bare, is_bare};
use scl_terminal::closest_name;
use scl_topology::diagnostic::Diagnostic;
use scl_topology::source::Span;

/// Words that say at a component where it runs.
pub(super) const PLACES: [&str; 7] = ["machine", "host", "node", "hosts", "runson", "placement", "on"];

/// Maximum number of keys of a mapping among which one is searched that stands for another.
pub(super) const MOST_KEYS: usize = 200;

/// Words that mean the opposite of `essential`.
pub(super) const NOT_ESSENTIAL: [&str; 5] = ["optional", "nonessential", "ignorefailure", "allowfailure", "besteffort"];

/// The key that an unknown one probably means: another tool's word for it, or a similar name.
pub(super) fn likely_key<'k>(word: &str, allowed: &[&'k Key]) -> Option<&'k str> {
    likely_keys(word, allowed).first().copied()
}

pub(super) fn likely_keys<'k>(word: &str, allowed: &[&'k Key]) -> Vec<&'k str> {
    let word_alone = bare(word);
    if let Some(key) = allowed.iter().find(|key| is_bare(key.name, &word_alone)) {
        return vec![key.name];
    }
    let called: Vec<&str> = allowed.iter().filter(|key| is_called(key, &word_alone)).map(|key| key.name).collect();
    if !called.is_empty() {
        return called;
    }
    let is_other = |words: &[&str]| words.contains(&word_alone.as_str());
    if Habit::of(word).is_some() || is_other(&PLACES) || is_other(&NOT_ESSENTIAL) {
        return Vec::new();
    }
    let lower = word.to_lowercase().replace(['-', ' '], "_");
    closest_name(&lower, allowed.iter().map(|key| key.name)).into_iter().collect()
}

/// The problem of an unknown key without its advice.
pub(super) fn problem(key: &str, at: Span, owner: &str) -> Diagnostic {
    UNKNOWN_KEY.at(format!("unknown key `{key}` in {owner}"), at, "")
}
