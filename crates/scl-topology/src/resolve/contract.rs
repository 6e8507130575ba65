//! Contracts: short hashes of what two ends must agree on.

use crate::fingerprint;
use crate::topology::{ConnectionId, GateId, GateKind, Topology, TypeName};

/// The contract of a connection: eight characters of `a-z2-7`.
pub(super) fn contract(topology: &Topology, connection: ConnectionId) -> String {
    // The receiving end has one contract for all its peers, so it is the one that counts.
    gate_contract(topology, topology.connection(connection).sink())
}

/// The contract of a gate with any of its peers: eight characters of `a-z2-7`.
pub(super) fn gate_contract(topology: &Topology, gate: GateId) -> String {
    let gate = topology.gate(gate);
    let pattern = match gate.kind() {
        GateKind::Pub | GateKind::Sub => "pub/sub",
        GateKind::Req | GateKind::Rep => "req/rep",
        GateKind::Push | GateKind::Pull => "push/pull",
    };
    let mut types = gate.payload().types().into_iter().map(TypeName::dotted);
    let [first, second] = [types.next(), types.next()].map(Option::unwrap_or_default);
    fingerprint::short([pattern, first, second, gate.codec().word()])
}
