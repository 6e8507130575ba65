//! Gates and peers, as errors and logs name them.

use crate::spec::{ConnectionSpec, GateSpec};
use std::fmt;

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

impl fmt::Display for GateName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.component, self.gate)
    }
}

/// The gate at the other end of a connection, for messages: `` `sensor.measurements` ``.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PeerName {
    component: &'static str,
    gate: &'static str,
}

impl PeerName {
    pub(crate) fn of(connection: &ConnectionSpec) -> Self {
        Self { component: connection.peer_component, gate: connection.peer_gate }
    }

    /// The component.
    pub fn component(&self) -> &'static str {
        self.component
    }

    /// Its gate.
    pub fn gate(&self) -> &'static str {
        self.gate
    }
}

impl fmt::Display for PeerName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}.{}`", self.component, self.gate)
    }
}

/// The other end of a connection, or the possible ones, for messages.
#[derive(Debug, Clone, Copy)]
pub struct Peers(pub(crate) &'static [ConnectionSpec]);

impl Peers {
    /// All peers of a gate.
    pub(crate) fn of(gate: &GateSpec) -> Self {
        Self(gate.connections)
    }
}

impl fmt::Display for Peers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return f.write_str("any peer (the topology declares no connection for it)");
        }
        for (index, connection) in self.0.iter().enumerate() {
            let separator = if index == 0 { "" } else { " or " };
            write!(f, "{separator}{}", PeerName::of(connection))?;
        }
        Ok(())
    }
}

/// A peer that is not connected.
#[derive(Debug, Clone)]
pub(crate) struct Missing {
    pub(crate) connection: &'static ConnectionSpec,
    /// Why this end does not connect to it, if it refuses to.
    pub(crate) refusal: Option<String>,
}
