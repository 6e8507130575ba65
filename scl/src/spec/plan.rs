//! From the constants of a program back to the plan that they were made from.

use super::{ComponentSpec, GateSpec, LinkSpec};
use scl_plan::{ConnectionPlan, GatePlan, Payload, Plan};

impl ComponentSpec {
    /// The plan, without its messages.
    pub(crate) fn plan(&self) -> Plan {
        Plan {
            system: self.system.to_owned(),
            component: self.name.to_owned(),
            declared_at: self.declared_at.to_owned(),
            schema: None,
            gates: self.gates.iter().map(gate_plan).collect(),
        }
    }
}

fn gate_plan(gate: &GateSpec) -> GatePlan {
    GatePlan {
        name: gate.name.to_owned(),
        kind: gate.kind,
        payload: payload(gate),
        codec: gate.codec.to_owned(),
        declared_at: gate.declared_at.to_owned(),
        endpoint: if_any(gate.endpoint),
        tap: if_any(gate.tap),
        contract: gate.contract.to_owned(),
        options: gate.options.clone(),
        connections: gate.links.iter().map(connection_plan).collect(),
    }
}

/// Reads what `Payload` displays.
fn payload(gate: &GateSpec) -> Payload {
    match gate.payload.split_once(" -> ").filter(|_| gate.kind.exchanges()) {
        Some((request, reply)) => Payload::Exchange { request: request.to_owned(), reply: reply.to_owned() },
        None if gate.payload == "bytes" => Payload::Bytes,
        None => Payload::Message(gate.payload.to_owned()),
    }
}

fn connection_plan(link: &LinkSpec) -> ConnectionPlan {
    ConnectionPlan {
        peer_component: link.peer_component.to_owned(),
        peer_gate: link.peer_gate.to_owned(),
        endpoint: link.endpoint.to_owned(),
        contract: link.contract.to_owned(),
        required: link.required,
        queue: link.queue,
        when_full: link.when_full,
        max_size: link.max_size,
    }
}

fn if_any(name: &str) -> Option<String> {
    (!name.is_empty()).then(|| name.to_owned())
}
