//! Losses of one gate, found by gaps in the numbers of its messages.

/// Counts a gate's lost messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Losses {
    /// The next number expected; `None` before the first message of a gate that was running when recording began.
    next: Option<u64>,
    /// When the last message was sent.
    sent_ns: u64,
    /// Messages lost since the last call of [`take`](Self::take).
    pending: u64,
}

impl Losses {
    /// For a gate that was running when recording began: messages sent before do not count as lost.
    pub(crate) fn running() -> Self {
        Self { next: None, sent_ns: 0, pending: 0 }
    }

    /// For a gate of a component that started during the recording: messages sent before the recorder was connected
    /// count as lost.
    pub(crate) fn started() -> Self {
        Self { next: Some(0), sent_ns: 0, pending: 0 }
    }

    /// Returns true if this is the last message seen: a latched gate sends its last message again when the recorder
    /// reconnects.
    pub(crate) fn is_last(&self, sequence: u64, sent_ns: u64) -> bool {
        self.next == Some(sequence + 1) && self.sent_ns == sent_ns
    }

    /// Counts the messages lost before this one, given its number and send time.
    pub(crate) fn see(&mut self, sequence: u64, sent_ns: u64) {
        let expected = match self.next {
            None => sequence,
            // The component has restarted.
            Some(next) if sequence < next => 0,
            Some(next) => next,
        };
        self.pending += sequence - expected;
        (self.next, self.sent_ns) = (Some(sequence + 1), sent_ns);
    }

    /// Adds messages that did not fit into the queue, and those lost before them.
    pub(crate) fn add(&mut self, lost: u64) {
        self.pending += lost;
    }

    /// Returns the number of messages lost since the last call.
    pub(crate) fn take(&mut self) -> u64 {
        std::mem::take(&mut self.pending)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_and_restarts_are_counted() {
        let cases = [
            (Losses::running(), &[7, 8, 9][..], 0),
            (Losses::running(), &[7, 10], 2),
            (Losses::running(), &[7, 8, 0, 1], 0),
            (Losses::running(), &[7, 8, 3], 3),
            (Losses::started(), &[0, 1], 0),
            (Losses::started(), &[2, 3], 2),
        ];
        for (mut losses, sequences, expected) in cases {
            sequences.iter().for_each(|&sequence| losses.see(sequence, 1));
            assert_eq!(losses.take(), expected, "{sequences:?}");
            assert_eq!(losses.take(), 0);
        }
    }

    #[test]
    fn only_the_message_that_was_seen_last_is_known() {
        let mut losses = Losses::running();
        assert!(!losses.is_last(7, 1));
        losses.see(7, 1);
        assert!(losses.is_last(7, 1));
        assert!(!losses.is_last(6, 1) && !losses.is_last(8, 1));
        assert!(!losses.is_last(7, 2), "of a component that has started again");
    }
}
