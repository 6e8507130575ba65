//! Turns the constants of a program back into the plan from which they were made.

use super::{ComponentSpec, ConnectionSpec, GateSpec};
use scl_plan::{ConnectionPlan, GatePlan, Payload, Plan};

impl ComponentSpec {
    /// Returns the plan, without its messages.
    pub(crate) fn plan(&self) -> Plan {
        Plan {
            system: self.system.to_owned(),
            component: self.name.to_owned(),
            declared_at: self.declared_at.to_owned(),
            schema: None,
            parameters: self.parameters.to_vec(),
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
        connections: gate.connections.iter().map(connection_plan).collect(),
    }
}

/// Parses a payload as `Payload` displays it.
fn payload(gate: &GateSpec) -> Payload {
    match gate.exchanged() {
        Some((request, reply)) => Payload::Exchange { request: request.to_owned(), reply: reply.to_owned() },
        None if gate.payload == "bytes" => Payload::Bytes,
        None => Payload::Message(gate.payload.to_owned()),
    }
}

fn connection_plan(connection: &ConnectionSpec) -> ConnectionPlan {
    ConnectionPlan {
        peer_component: connection.peer_component.to_owned(),
        peer_gate: connection.peer_gate.to_owned(),
        endpoint: connection.endpoint.to_owned(),
        contract: connection.contract.to_owned(),
        required: connection.required,
        queue: connection.queue,
        when_full: connection.when_full,
        max_size: connection.max_size,
        max_age: connection.max_age,
    }
}

fn if_any(name: &str) -> Option<String> {
    (!name.is_empty()).then(|| name.to_owned())
}
