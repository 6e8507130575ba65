//! Queue policies: what a full queue does.

use super::Word;

/// What a full queue does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum WhenFull {
    /// The oldest waiting message is dropped.
    #[default]
    DropOldest,
    /// The new message is dropped.
    DropNewest,
    /// The sender waits, if it allows that.
    Wait,
}

impl WhenFull {
    /// All of them, in the order in which messages list them.
    pub const ALL: [WhenFull; 3] = [WhenFull::DropOldest, WhenFull::DropNewest, WhenFull::Wait];

    /// The rows of [`ALL`](Self::ALL).
    pub(super) const ROWS: [Word; 3] = {
        let [first, second, third] = Self::ALL;
        [first.row(), second.row(), third.row()]
    };

    const fn row(self) -> Word {
        match self {
            WhenFull::DropOldest => Word {
                word: "drop_oldest",
                summary: "drops the oldest waiting message",
                text: "The sender never waits. The receiver gets the newest messages: with `queue: 1` only the newest. \
                       Suits measurements and states. Each drop is counted in the statistics of the connection.",
            },
            WhenFull::DropNewest => Word {
                word: "drop_newest",
                summary: "drops the message that arrives",
                text: "The sender never waits. The receiver gets the messages that arrived first. Suits the start of a \
                       recording. Each drop is counted in the statistics of the connection.",
            },
            WhenFull::Wait => Word {
                word: "wait",
                summary: "makes the sender wait",
                text: "No message is dropped. A call that sends waits until the queue has room; the sender allows that \
                       with `backpressure: true`. Suits recorders and work that must be done. Components that wait for \
                       each other in a circle can deadlock.",
            },
        }
    }

    /// The word in the file.
    pub const fn word(self) -> &'static str {
        self.row().word
    }

    /// The policy of a word.
    pub fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|policy| policy.word() == word)
    }
}
