//! Checks that the transports offer what a component's gates need, before the component is registered.

use super::transports::Transports;
use crate::error::{GateName, MissingGuarantee, OpenError};
use crate::spec::{ComponentSpec, GateKind, GateSpec, WhenFull};
use crate::transport::{Guarantee, Transport};
use std::slice::from_ref;

/// Refuses a component that needs more than its transports offer, and names everything that is missing.
pub(super) fn check(spec: &'static ComponentSpec, transports: &Transports) -> Result<(), OpenError> {
    let missing: Vec<MissingGuarantee> = spec
        .gates
        .iter()
        .flat_map(|gate| {
            let lacks = |(guarantee, option)| {
                let offered = |transport: &dyn Transport| transport.guarantees().contains(guarantee);
                let offered = if gate.connections.is_empty() || !gate.endpoint.is_empty() {
                    offered(transports.of(gate, gate.connections))
                } else {
                    gate.connections.iter().all(|connection| offered(transports.of(gate, from_ref(connection))))
                };
                (!offered).then(|| MissingGuarantee { gate: GateName::new(spec.name, gate.name), option, guarantee })
            };
            needs(gate).into_iter().filter_map(lacks)
        })
        .collect();
    if missing.is_empty() { Ok(()) } else { Err(OpenError::Guarantees { component: spec.name, missing }) }
}

/// What a gate needs, and the part of its declaration that asks for it.
fn needs(gate: &GateSpec) -> Vec<(Guarantee, &'static str)> {
    let options = &gate.options;
    match gate.kind {
        GateKind::Req => vec![(Guarantee::Requests, "req")],
        GateKind::Rep => vec![(Guarantee::Requests, "rep")],
        GateKind::Sub | GateKind::Pull if options.when_full == WhenFull::Wait => {
            vec![(Guarantee::Waiting, "when_full: wait")]
        }
        GateKind::Sub | GateKind::Pull if gate.newest_only() => vec![(Guarantee::Freshness, "queue: 1")],
        // A gate that waits instead of dropping must also know, at the end of its program, that its peers have taken
        // everything.
        GateKind::Pub | GateKind::Push
            if gate.connections.iter().any(|connection| options.waits_for(connection.when_full)) =>
        {
            vec![(Guarantee::Waiting, "backpressure: true"), (Guarantee::Acknowledgement, "backpressure: true")]
        }
        _ => Vec::new(),
    }
}
