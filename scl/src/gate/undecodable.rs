//! Messages that a gate's codec cannot read: counted, and reported to the log or to the caller as the gate declares.

use crate::causes::text_with_causes;
use crate::error::RecvError;
use crate::spec::{GateSpec, Undecodable};
use std::time::{Duration, Instant};

/// How many undecodable messages a waiting call skips before other tasks have their turn.
pub(super) const AT_ONCE: usize = 64;
/// How long a call that does not wait may be held up by undecodable messages.
const LONGEST_SKIP: Duration = Duration::from_millis(10);

/// Number of undecodable messages of each link.
#[derive(Debug, Clone)]
pub(super) struct UndecodableCount {
    over: Vec<u64>,
}

impl UndecodableCount {
    pub(super) fn of_links(links: usize) -> Self {
        Self { over: vec![0; links.max(1)] }
    }

    /// Counts an undecodable message. Returns true for the first one of a link.
    pub(super) fn add(&mut self, link: usize) -> bool {
        let Some(count) = self.over.get_mut(link) else { return false };
        *count += 1;
        *count == 1
    }

    pub(super) fn total(&self) -> u64 {
        self.over.iter().sum()
    }
}

/// Returns true if the gate skips undecodable messages.
pub(super) fn skips(gate: &GateSpec) -> bool {
    gate.options.undecodable == Undecodable::Skip
}

/// Returns the result of a call that has tried to decode a message, or `None` if the message is skipped.
pub(super) fn unless_skipped<R>(gate: &GateSpec, decoded: Result<R, RecvError>) -> Option<Result<R, RecvError>> {
    if decoded.is_err() && skips(gate) { None } else { Some(decoded) }
}

/// Logs a skipped message, but only the `first` of each peer: a peer whose messages are undecodable sends many of them.
pub(super) fn report(gate: &GateSpec, error: &RecvError, first: bool) {
    if first && skips(gate) {
        let error = text_with_causes(error);
        tracing::warn!("{error}; such messages are skipped and counted, and not logged again for this peer");
    }
}

/// The time that a call which does not wait may spend on skipping.
#[derive(Default)]
pub(super) struct SkipLimit {
    since: Option<Instant>,
}

impl SkipLimit {
    /// Called after a message was skipped. Returns true if the call has to end.
    pub(super) fn is_over(&mut self) -> bool {
        self.since.get_or_insert_with(Instant::now).elapsed() > LONGEST_SKIP
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_first_message_of_each_link_is_reported() {
        let mut count = UndecodableCount::of_links(2);
        assert_eq!([count.add(0), count.add(0), count.add(1), count.add(1)], [true, false, true, false]);
        assert_eq!(count.total(), 4);
    }
}
