//! What a gate has done so far.

use rustix::time::{ClockId, clock_gettime};
use std::time::{Duration, Instant};

/// A gate's account since its component was opened.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct GateStats {
    /// Messages handed to peers, each peer counted: a message to three subscribers counts three times.
    pub sent: u64,
    /// Messages received.
    pub received: u64,
    /// Messages dropped because a queue was full, the oldest giving way.
    pub dropped_oldest: u64,
    /// Messages dropped because a queue was full, the newest giving way.
    pub dropped_newest: u64,
    /// Messages received that were no message: not one frame, or not what the codec reads.
    pub rejected: u64,
    /// Bytes of the messages sent or received.
    pub bytes: u64,
    /// Messages that wait in this program for a peer or for a receiving call.
    pub waiting: usize,
    /// Peers connected now, where the gate can know.
    pub peers: usize,
    /// When a message last moved, exact to a few milliseconds.
    pub last_activity: Option<Instant>,
}

/// The running account of one connection or gate.
#[derive(Debug, Clone, Default)]
pub(crate) struct Counts {
    pub(crate) messages: u64,
    pub(crate) bytes: u64,
    pub(crate) dropped_oldest: u64,
    pub(crate) dropped_newest: u64,
    pub(crate) rejected: u64,
    last: Option<CoarseTime>,
}

/// The operating system's coarse clock, exact to a few milliseconds: a sixth of the price of an exact one, paid for each
/// message.
#[derive(Debug, Clone, Copy)]
struct CoarseTime(Duration);

impl CoarseTime {
    fn now() -> Self {
        let now = clock_gettime(ClockId::MonotonicCoarse);
        Self(Duration::new(now.tv_sec.unsigned_abs(), now.tv_nsec.unsigned_abs() as u32))
    }

    fn to_instant(self) -> Option<Instant> {
        Instant::now().checked_sub(Self::now().0.saturating_sub(self.0))
    }
}

impl Counts {
    pub(crate) fn moved(&mut self, bytes: usize) {
        self.messages += 1;
        self.bytes += bytes as u64;
        self.last = Some(CoarseTime::now());
    }

    pub(crate) fn dropped(&mut self, newest: bool) {
        if newest {
            self.dropped_newest += 1;
        } else {
            self.dropped_oldest += 1;
        }
    }

    pub(crate) fn add_to(&self, stats: &mut GateStats) {
        stats.dropped_oldest += self.dropped_oldest;
        stats.dropped_newest += self.dropped_newest;
        stats.rejected += self.rejected;
        stats.bytes += self.bytes;
        stats.last_activity = stats.last_activity.max(self.last.and_then(CoarseTime::to_instant));
    }
}
