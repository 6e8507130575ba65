//! The order in which messages of a stream arrive.

use scl_tests::say;
use std::collections::HashMap;

/// Checks that messages of each sender arrive in order. Says of the first message that it is there.
#[derive(Default)]
pub(crate) struct Order {
    without_gaps: bool,
    /// The last number of each sender.
    last: HashMap<u64, u64>,
}

impl Order {
    /// For gates that lose nothing.
    pub(crate) fn without_gaps() -> Self {
        Self { without_gaps: true, ..Self::default() }
    }

    /// Adds a number, whose upper half tells who has sent it.
    ///
    /// # Panics
    /// If it is not after the one before.
    pub(crate) fn add(&mut self, number: u64) {
        if self.last.is_empty() {
            say("flows");
        }
        if let Some(last) = self.last.insert(number >> 32, number) {
            let follows = if self.without_gaps { number == last + 1 } else { number > last };
            assert!(follows, "{number:#x} after {last:#x}");
        }
    }
}
