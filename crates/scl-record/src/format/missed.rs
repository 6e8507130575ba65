//! The messages that gates have missed, as an attachment of a recording.

use serde::{Deserialize, Serialize};

/// A gate with a `rate` or a `deadline` that has missed messages since the recording began.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MissedGate {
    /// `controller.sensor`.
    pub gate: String,
    /// Messages that it did not send in the promised period, or did not get within its deadline, each sender counted.
    pub missed: u64,
    /// Its senders, if it receives and can tell them apart.
    pub peers: Vec<MissedPeer>,
}

/// A sender of such a gate.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MissedPeer {
    /// `sensor.measurements`.
    pub gate: String,
    /// Its messages among them.
    pub missed: u64,
}
