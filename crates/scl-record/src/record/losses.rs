//! Losses of one gate, found by gaps in the numbers of its messages.

/// What is expected at a tap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Losses {
    /// The next number; `None` while the recorder has not seen the gate, because it joined when the gate was running.
    next: Option<u64>,
    /// Lost and not yet reported with a message.
    pending: u64,
}

impl Losses {
    /// A gate that was running when recording began: what it sent before is not lost.
    pub(crate) fn running() -> Self {
        Self { next: None, pending: 0 }
    }

    /// A gate of a component that started during the recording: what it sent before the recorder was connected is lost.
    pub(crate) fn started() -> Self {
        Self { next: Some(0), pending: 0 }
    }

    /// Takes note of a message's number.
    pub(crate) fn see(&mut self, sequence: u64) {
        let expected = match self.next {
            None => sequence,
            // The component has started again.
            Some(next) if sequence < next => 0,
            Some(next) => next,
        };
        self.pending += sequence - expected;
        self.next = Some(sequence + 1);
    }

    /// Adds messages that were seen but found no room, and what was lost before them.
    pub(crate) fn add(&mut self, lost: u64) {
        self.pending += lost;
    }

    /// Number of lost messages since the last call.
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
            sequences.iter().for_each(|&sequence| losses.see(sequence));
            assert_eq!(losses.take(), expected, "{sequences:?}");
            assert_eq!(losses.take(), 0);
        }
    }
}
