//! Habits at one place, found by their words.

use super::{Habit, compact};
use std::collections::HashMap;
use std::sync::OnceLock;

/// The habits that are known at one place.
pub(crate) struct Table {
    habits: &'static [Habit],
    /// Hostile files look up a word in every few bytes.
    by_word: OnceLock<HashMap<&'static str, &'static Habit>>,
}

impl Table {
    pub(super) const fn new(habits: &'static [Habit]) -> Self {
        Self { habits, by_word: OnceLock::new() }
    }

    /// The habit that a word comes from.
    pub(crate) fn find(&'static self, word: &str) -> Option<&'static Habit> {
        let words = || self.habits.iter().flat_map(|habit| habit.words().map(move |word| (word, habit))).collect();
        self.by_word.get_or_init(words).get(compact(word).as_str()).copied()
    }

    #[cfg(test)]
    pub(super) fn habits(&self) -> &'static [Habit] {
        self.habits
    }
}
