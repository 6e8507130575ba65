//! The clock of a recording, which may have been set while it was made.
//!
//! A step back is certain, because a recorder receives the messages of a topic one after the other. A step forward
//! cannot be distinguished from a time in which nothing was sent.

use super::RecordedMessage;

/// Smallest step back that is taken out, in nanoseconds. Smaller ones remain; a replay still keeps each topic's
/// messages in order.
const SMALLEST_STEP: u64 = 100_000_000;

/// Takes steps back out of the times of messages, which must be passed in the order of the file.
#[derive(Debug, Default)]
pub(crate) struct Clock {
    /// The total time by which the clock was set back so far, in nanoseconds.
    set_back: u64,
    /// The latest receive time, and that of each channel, since the clock was last set back.
    latest: Option<u64>,
    channels: Vec<u64>,
}

/// Times in nanoseconds, as if the clock had not been set back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Times {
    pub(crate) sent: u64,
    pub(crate) received: u64,
    /// The time by which the clock was set back just before this message; `None` if it was not.
    pub(crate) step: Option<u64>,
    /// The time from receiving the previous message to receiving this one.
    pub(crate) gap: u64,
}

impl Clock {
    /// A clock that was set back by this time before.
    pub(super) fn set_back_by(set_back: u64) -> Self {
        Self { set_back, ..Self::default() }
    }

    /// The time by which it was set back so far, in nanoseconds.
    pub(super) fn set_back(&self) -> u64 {
        self.set_back
    }

    /// Returns the corrected times of the next message.
    pub(crate) fn times(&mut self, message: &RecordedMessage) -> Times {
        let received = message.received_ns;
        if self.channels.len() <= message.channel {
            self.channels.resize(message.channel + 1, 0);
        }
        let latest = self.latest.unwrap_or(received);
        // Other programs may write one topic after the other, so compare each topic only with itself.
        let step = (received.saturating_add(SMALLEST_STEP) < self.channels[message.channel])
            .then(|| latest.saturating_sub(received));
        if let Some(step) = step {
            self.set_back = self.set_back.saturating_add(step);
            self.channels.fill(0);
            self.latest = None;
        }
        self.channels[message.channel] = self.channels[message.channel].max(received);
        self.latest = Some(self.latest.map_or(received, |latest| latest.max(received)));
        let steady = received.saturating_add(self.set_back);
        let sent = message.sent_ns.saturating_add(self.set_back);
        Times {
            // A message sent before the step carries the time of the old clock, so cap it at the receive time.
            sent: if self.set_back > 0 { sent.min(steady) } else { sent },
            received: steady,
            step,
            gap: if step.is_some() { 0 } else { received.saturating_sub(latest) },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Messages as channel and times of sending and receiving in seconds, and the times of sending without steps.
    fn steady(messages: &[(usize, u64, u64)]) -> Vec<(u64, Option<u64>)> {
        let mut clock = Clock::default();
        let seconds = |&(channel, sent, received): &(usize, u64, u64)| RecordedMessage {
            channel,
            sequence: 0,
            sent_ns: sent * 1_000_000_000,
            received_ns: received * 1_000_000_000,
            payload: Default::default(),
        };
        let times = messages.iter().map(seconds).map(|message| clock.times(&message));
        times.map(|times| (times.sent / 1_000_000_000, times.step.map(|step| step / 1_000_000_000))).collect()
    }

    #[test]
    fn a_clock_that_runs_is_left_alone() {
        let messages = [(0, 5000, 5001), (1, 5000, 5002), (0, 5002, 5002), (0, 9000, 9000), (1, 8000, 9001)];
        let sent = messages.map(|(_, sent, _)| (sent, None));
        assert_eq!(steady(&messages), sent);
    }

    #[test]
    fn steps_back_are_taken_out() {
        let messages =
            [(0, 5000, 5000), (0, 5001, 5001), (0, 1402, 1402), (1, 1403, 1403), (0, 300, 300), (0, 301, 301)];
        let expected = [(5000, None), (5001, None), (5001, Some(3599)), (5002, None), (5002, Some(1103)), (5003, None)];
        assert_eq!(steady(&messages), expected);
    }

    #[test]
    fn a_message_that_was_under_way_during_a_step_is_not_sent_late() {
        let messages = [(0, 5000, 5000), (0, 5001, 1401), (0, 1402, 1402)];
        assert_eq!(steady(&messages), [(5000, None), (5000, Some(3599)), (5001, None)]);
    }

    #[test]
    fn topics_one_after_the_other_are_no_steps() {
        let messages = [(0, 5000, 5000), (0, 6000, 6000), (1, 5000, 5000), (1, 6000, 6000)];
        assert_eq!(steady(&messages), messages.map(|(_, sent, _)| (sent, None)));
    }
}
