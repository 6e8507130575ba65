//! What a gate has done so far.

use crate::runtime_dir::GateFigures;
use rustix::time::{ClockId, clock_gettime};
use std::time::{Duration, Instant, SystemTime};

/// A gate's counts since its component was opened.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct GateStats {
    /// Messages handed to peers, each peer counted: a message to three subscribers counts three times.
    pub sent: u64,
    /// Messages received.
    pub received: u64,
    /// Messages replaced by a newer one in a queue of one with `drop_oldest`, which `queue: 1` declares; not counted as
    /// dropped.
    pub replaced: u64,
    /// Messages dropped because a queue was full and `drop_oldest` was declared.
    pub dropped_oldest: u64,
    /// Messages dropped because a queue was full and `drop_newest` was declared.
    pub dropped_newest: u64,
    /// Messages dropped for plain ZeroMQ subscribers and for observers at the gate's tap, which never delay a gate.
    pub dropped_for_observers: u64,
    /// Messages that were on their way, or waited in the peer's gate, when their connection broke.
    pub lost: u64,
    /// Messages received that could not be used: they had several frames, or the codec could not read them.
    pub rejected: u64,
    /// Rejected messages that the codec could not read; see the option `undecodable`.
    pub undecodable: u64,
    /// Messages that did not come when they were due: those that a sending gate did not send in the `rate` or `period`
    /// that it promises, those that a receiving gate did not get within its `deadline`, each sender counted.
    pub missed: u64,
    /// Of `received`, those that the program did not get, because they were older than the `max_age` of the gate by
    /// then.
    pub expired: u64,
    /// Bytes of the messages sent or received.
    pub bytes: u64,
    /// Messages that wait in this program for a peer or for a receiving call.
    pub waiting: usize,
    /// Peers connected now.
    pub peers: usize,
    /// When a message last moved, exact to a few milliseconds.
    pub last_activity: Option<Instant>,
}

/// What became of the messages of one connection, at its sending end.
///
/// At any time `published = taken + replaced + dropped_oldest + dropped_newest + lost + waiting`. Of these, only
/// `waiting` ever falls.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct PeerStats {
    /// The gate at the other end: `` `controller.sensor` ``, without the quotes.
    pub peer: String,
    /// Whether the peer is connected.
    pub connected: bool,
    /// Messages sent to this peer, including those that were sent once more ([`latched`](Self::latched)).
    pub published: u64,
    /// How often the last message of a gate with `latched: true` was sent once more, to a subscriber that joined.
    pub latched: u64,
    /// Messages that the peer's program has received or skipped, or that its gate has dropped and counted there, as far
    /// as the peer has acknowledged them: it does so when half of a window is on its way, whenever it writes figures
    /// (`SCL_STATS`), and when it ends. For a plain ZeroMQ program, messages handed to its socket.
    pub taken: u64,
    /// Messages replaced by a newer one in a queue of one with `drop_oldest`; not counted as dropped.
    pub replaced: u64,
    /// Messages dropped because the queue was full and `drop_oldest` was declared.
    pub dropped_oldest: u64,
    /// Messages dropped because the queue was full and `drop_newest` was declared.
    pub dropped_newest: u64,
    /// Messages that were on their way, or waited in the peer's gate, when the connection broke. A program that was
    /// killed may have received some of them; one that ended in order has received none.
    pub lost: u64,
    /// Messages that wait in the queue, are on their way, or wait in the peer's gate.
    pub waiting: u64,
}

impl GateStats {
    /// Returns the counts from the figures that `read` fills in, which are all zero before.
    pub(crate) fn of(read: impl FnOnce(&mut GateFigures)) -> Self {
        let mut figures = GateFigures::default();
        read(&mut figures);
        let last_activity = figures.last_activity.map(|last| last.elapsed().unwrap_or_default());
        Self {
            sent: figures.sent,
            received: figures.received,
            replaced: figures.replaced,
            dropped_oldest: figures.dropped_oldest,
            dropped_newest: figures.dropped_newest,
            dropped_for_observers: figures.dropped_for_observers,
            lost: figures.lost,
            rejected: figures.rejected,
            undecodable: figures.undecodable,
            missed: figures.missed,
            expired: figures.expired,
            bytes: figures.bytes,
            waiting: figures.waiting as usize,
            peers: figures.peers as usize,
            last_activity: last_activity.and_then(|ago| Instant::now().checked_sub(ago)),
        }
    }
}

/// Number of bytes moved, and when a message last moved.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Activity {
    bytes: u64,
    /// When a message last moved, exact to a few milliseconds.
    pub(super) last: Option<CoarseTime>,
}

impl Activity {
    pub(crate) fn add(&mut self, bytes: usize) {
        self.bytes += bytes as u64;
        self.last = Some(CoarseTime::now());
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self { bytes: self.bytes + other.bytes, last: self.last.max(other.last) }
    }

    pub(crate) fn add_to(&self, figures: &mut GateFigures) {
        figures.bytes += self.bytes;
        figures.last_activity = figures.last_activity.max(self.last.and_then(CoarseTime::to_system_time));
    }
}

/// The operating system's coarse clock, exact to a few milliseconds. It is read for each message and costs a sixth of
/// the exact one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct CoarseTime(Duration);

impl CoarseTime {
    fn now() -> Self {
        let now = clock_gettime(ClockId::MonotonicCoarse);
        Self(Duration::new(now.tv_sec.unsigned_abs(), now.tv_nsec.unsigned_abs() as u32))
    }

    fn to_system_time(self) -> Option<SystemTime> {
        SystemTime::now().checked_sub(self.elapsed())
    }

    fn elapsed(self) -> Duration {
        Self::now().0.saturating_sub(self.0)
    }
}
