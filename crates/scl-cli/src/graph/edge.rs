//! What both formats show for a connection.

use scl_topology::topology::{Connection, GateKind, Payload, Topology};

/// A connection as it is drawn: from the end that sends (or asks) to the end that receives (or answers).
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Edge {
    /// The types of the messages, for example `rover.Measurement`; empty for bytes.
    pub(crate) types: String,
    /// Whether an answer comes back.
    pub(crate) answered: bool,
}

/// The edge of a connection.
pub(crate) fn edge_of(topology: &Topology, connection: &Connection) -> Edge {
    let source = topology.gate(connection.source());
    let types = match source.payload() {
        Payload::Bytes => String::new(),
        typed => typed.to_string(),
    };
    Edge { types, answered: source.kind() == GateKind::Req }
}
