//! `<component>.stats`: what a component has done so far, written for tools every half a second by default.
//!
//! The file is one block of fixed length, written in place, so a reader needs no help from the component: reading works
//! while the component hangs, and after it was killed. A component that closes removes its file. The environment
//! variable `SCL_STATS` sets the period (`500ms` by default), or switches the file off (`off`).
//!
//! `docs/stats.md` describes the format, for readers in other languages. A writer writes a counter at the beginning of
//! the block, then the figures, then the same counter at the end; a reader reads in the opposite order, so that equal
//! counters prove that it has read a whole block.

mod file;
mod layout;

pub(crate) use file::StatsFile;

use super::SystemDir;
use crate::spec::ComponentSpec;
use std::time::{Duration, SystemTime};

/// What a component has done since it was opened, as it wrote it last.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ComponentStats {
    /// When this was written. A component that hangs or is dead no longer writes.
    pub written: SystemTime,
    /// How often the component writes.
    pub period: Duration,
    /// The process that wrote it, as [`Announcement::pid`](super::Announcement::pid).
    pub pid: u32,
    /// When the component was opened, in whole milliseconds: equal to
    /// [`Announcement::started`](super::Announcement::started) if the two belong together.
    pub started: SystemTime,
    /// Whether all required peers were connected.
    pub ready: bool,
    /// The gates, in the order of the plan.
    pub gates: Vec<GateFigures>,
}

/// What a gate has done: the counts of [`GateStats`](crate::GateStats).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct GateFigures {
    /// Messages handed to peers, each peer counted.
    pub sent: u64,
    /// Messages received.
    pub received: u64,
    /// Messages replaced by a newer one in a queue of one with `drop_oldest`; not counted as dropped.
    pub replaced: u64,
    /// Messages dropped because a queue was full and `drop_oldest` was declared.
    pub dropped_oldest: u64,
    /// Messages dropped because a queue was full and `drop_newest` was declared.
    pub dropped_newest: u64,
    /// Messages dropped for plain ZeroMQ subscribers and for observers.
    pub dropped_for_observers: u64,
    /// The part of `dropped_for_observers` that was dropped for observers at the gate's tap, each observer counted.
    pub tap_dropped: u64,
    /// Messages that were on their way, or waited in the peer's gate, when their connection broke.
    pub lost: u64,
    /// Messages received that could not be used.
    pub rejected: u64,
    /// Rejected messages that the codec could not read.
    pub undecodable: u64,
    /// Messages that were not sent in the promised period, or not received within the deadline.
    pub missed: u64,
    /// Messages that were too old when the program would have received them, and were dropped.
    pub expired: u64,
    /// Bytes of the messages sent or received.
    pub bytes: u64,
    /// Messages that wait in the program's queues.
    pub waiting: u64,
    /// Peers connected.
    pub peers: u64,
    /// When a message last moved, exact to a few milliseconds.
    pub last_activity: Option<SystemTime>,
    /// The connections, in the order of the plan.
    pub connections: Vec<ConnectionFigures>,
}

/// One connection of a gate.
///
/// At a `pub` or `push` gate, the number of messages sent is [`published`](Self::published). Only `waiting` and
/// `in_flight` ever fall.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ConnectionFigures {
    /// Whether the peer is connected. A `pull` or `rep` gate cannot tell its peers apart: true if it has as many as the
    /// plan says.
    pub connected: bool,
    /// Messages that wait for the peer in the queue; at a `req` gate, a call that is under way. 0 at a gate that
    /// receives, whose messages wait in one queue.
    pub waiting: u64,
    /// Messages that the peer's program has received, as far as the peer has acknowledged them, which it does twice a
    /// second and when it ends. At a `req` gate: replies. At a gate that receives: messages received from this peer, or
    /// 0 if that is not known because several peers share an endpoint.
    pub taken: u64,
    /// Messages dropped because the queue was full.
    pub dropped: u64,
    /// Messages that were on their way, or waited in the peer's gate, when the connection broke.
    pub lost: u64,
    /// Messages replaced by a newer one in a queue of one with `drop_oldest`; not counted as dropped.
    pub replaced: u64,
    /// Messages that are on their way, wait in the peer's gate, or have been received and not been acknowledged yet.
    pub in_flight: u64,
    /// How often the last message of a gate with `latched: true` was sent once more, to a subscriber that joined.
    pub latched: u64,
    /// Messages that a gate that receives did not get from this peer within its deadline, or 0 if that is not known
    /// because several peers share an endpoint.
    pub missed: u64,
    /// Messages of this peer that were too old when the program would have received them, or 0 if that is not known.
    pub expired: u64,
}

impl ConnectionFigures {
    /// Returns the number of messages that a `pub` or `push` gate has sent to this peer, including those that were sent
    /// once more.
    pub fn published(&self) -> u64 {
        let Self { waiting, taken, dropped, lost, replaced, in_flight, .. } = self;
        taken + in_flight + waiting + replaced + dropped + lost
    }
}

impl ComponentStats {
    /// Returns the figures of a component that has done nothing yet.
    pub(crate) fn initial(spec: &ComponentSpec, pid: u32, started: SystemTime, period: Duration) -> Self {
        let gates = spec.gates.iter().map(|gate| GateFigures::of_connections(gate.connections.len())).collect();
        Self { written: started, period, pid, started, ready: false, gates }
    }

    /// Reads what a component wrote last, if there is such a file and it can be understood.
    ///
    /// It may be that of a killed process: see [`SystemDir::state`].
    pub fn read(dir: &SystemDir, component: &str) -> Option<Self> {
        file::read(&dir.file_of(component, ".stats").ok()?)
    }

    /// When a component wrote them last, by the clock of this machine. [`written`](Self::written) is by the component's
    /// own, which is another in simulated time.
    pub fn last_write(dir: &SystemDir, component: &str) -> Option<SystemTime> {
        std::fs::metadata(dir.file_of(component, ".stats").ok()?).ok()?.modified().ok()
    }
}

impl GateFigures {
    /// Returns figures that are all zero.
    pub(crate) fn of_connections(connections: usize) -> Self {
        Self { connections: vec![ConnectionFigures::default(); connections], ..Self::default() }
    }
}
