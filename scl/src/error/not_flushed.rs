//! Messages that a component could not hand over before it was closed.

use super::{GateName, PeerName};
use crate::time::Rounded;
use std::fmt;
use std::time::Duration;
use thiserror::Error;

/// A component was closed before its peers had taken everything.
#[derive(Debug, Error)]
#[non_exhaustive]
#[error("component `{component}` was closed after {} with messages left: {}", Rounded(*waited), super::listed(peers))]
pub struct NotFlushed {
    /// The component.
    pub component: &'static str,
    /// The peers that did not get everything.
    pub peers: Vec<Unflushed>,
    /// How long it waited.
    pub waited: Duration,
}

/// A peer that did not get everything.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Unflushed {
    /// The sending gate.
    pub gate: GateName,
    /// The peer.
    pub peer: PeerName,
    /// Number of messages that it has not taken.
    pub messages: u64,
    /// Whether its program was running when this was reported.
    pub running: bool,
    /// Whether the connection was declared lossless: `when_full: wait`, at a gate with `backpressure`.
    pub lossless: bool,
}

impl NotFlushed {
    pub(crate) fn of(
        component: &'static str,
        mut peers: Vec<Unflushed>,
        waited: Duration,
        is_running: &dyn Fn(&str) -> bool,
    ) -> Result<(), Self> {
        if peers.is_empty() {
            return Ok(());
        }
        peers.iter_mut().for_each(|left| left.running = is_running(left.peer.component()));
        Err(Self { component, peers, waited })
    }

    /// Returns true if a peer that was running, or one with a lossless connection, did not get everything. A peer that
    /// was not running at all could not be waited for.
    pub fn is_failure(&self) -> bool {
        self.peers.iter().any(|peer| peer.running || peer.lossless)
    }
}

impl fmt::Display for Unflushed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = if self.messages == 1 { "" } else { "s" };
        let running = if self.running { "" } else { ", which is not running" };
        write!(f, "{} message{plural} from `{}` to {}{running}", self.messages, self.gate, self.peer)
    }
}
