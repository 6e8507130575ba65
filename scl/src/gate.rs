//! Gates: the typed ends of connections, as the fields of a component.

pub(crate) mod encoding;
pub(crate) mod holding;
pub(crate) mod incoming;
mod outgoing;
mod publisher;
mod puller;
mod pusher;
mod receiving_gate;
mod replier;
mod requester;
pub(crate) mod sending;
mod sending_gate;
mod stats;
mod subscriber;

pub(crate) use outgoing::Outgoing;
pub use publisher::Pub;
pub use puller::Pull;
pub use pusher::Push;
pub use replier::{Rep, Request};
pub use requester::Req;
pub use stats::GateStats;
pub use subscriber::Sub;

use crate::component::Core;
use crate::spec::{GateSpec, LinkSpec};
use std::sync::Arc;

/// What a component can ask of each of its gates, whatever its kind.
pub trait AnyGate {
    /// What the topology says about the gate.
    fn spec(&self) -> &'static GateSpec;

    /// The required peers that are not connected. Gates that listen for any number of peers (`rep`, `pull`) cannot
    /// know theirs and name none.
    fn missing(&self) -> Vec<&'static LinkSpec>;

    #[doc(hidden)]
    fn core(&self) -> &Arc<Core>;
}

/// The full name of a gate, for messages: `controller.sensor`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GateName {
    component: &'static str,
    gate: &'static str,
}

impl GateName {
    pub(crate) fn new(component: &'static str, gate: &'static str) -> Self {
        Self { component, gate }
    }
}

impl std::fmt::Display for GateName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}.{}", self.component, self.gate)
    }
}

/// The other end of a connection, or several in question, for messages.
#[derive(Debug, Clone, Copy)]
pub struct Peers(pub(crate) &'static [LinkSpec]);

impl std::fmt::Display for Peers {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0.is_empty() {
            return f.write_str("nobody");
        }
        for (index, link) in self.0.iter().enumerate() {
            let separator = if index == 0 { "" } else { " or " };
            write!(f, "{separator}`{}.{}`", link.peer_component, link.peer_gate)?;
        }
        Ok(())
    }
}
