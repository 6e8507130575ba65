//! Waiting for the peers of a component.

use super::PeerName;
use crate::time::Rounded;
use std::fmt;
use std::time::Duration;
use thiserror::Error;

/// Not all required peers connected in time.
#[derive(Debug, Error)]
#[non_exhaustive]
#[error("component `{component}` is not ready after {}: {}", Rounded(*waited), super::listed(missing))]
pub struct NotReady {
    /// The component that waited.
    pub component: &'static str,
    /// The peers that are missing.
    pub missing: Vec<MissingPeer>,
    /// How long it waited.
    pub waited: Duration,
}

/// A required peer that is not connected.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct MissingPeer {
    /// The gate that waits for it.
    pub gate: &'static str,
    /// The peer.
    pub peer: PeerName,
    /// Why it is missing, as a sentence: `` `sensor.measurements` is not running ``.
    pub reason: String,
    /// Whether it runs, but this component refuses to connect to it, because their contracts or messages differ.
    pub refused: bool,
}

impl fmt::Display for MissingPeer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (gate `{}`)", self.reason, self.gate)
    }
}
