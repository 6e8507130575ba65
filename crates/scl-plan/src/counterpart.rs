//! The counterpart of a component: one opposite gate for each of its gates, for unit tests on the in-process transport.

use crate::kind::GateKind;
use crate::options::GateOptions;
use crate::plan::{ConnectionPlan, GatePlan, Plan};

impl Plan {
    /// The plan of this component's counterpart.
    ///
    /// Each of its gates stands in for all peers of one gate, at the endpoint of the first connection. It neither drops
    /// nor rejects messages: one that a test misses was dropped by the component under test. The counterpart of a gate
    /// without connections may have no connection either.
    #[must_use]
    pub fn counterpart(&self) -> Plan {
        Plan {
            system: self.system.clone(),
            component: format!("{}'s peers", self.component),
            declared_at: String::new(),
            schema: None,
            parameters: Vec::new(),
            gates: self.gates.iter().map(|gate| opposite(&self.component, gate)).collect(),
        }
    }
}

fn opposite(owner: &str, gate: &GatePlan) -> GatePlan {
    let kind = gate.kind.opposite();
    let first = gate.connections.first();
    let endpoint = first.map(|connection| connection.endpoint.clone()).or_else(|| gate.endpoint.clone());
    let contract = first.map_or(&gate.contract, |connection| &connection.contract).clone();
    GatePlan {
        name: gate.name.clone(),
        kind,
        payload: gate.payload.clone(),
        codec: gate.codec.clone(),
        declared_at: gate.declared_at.clone(),
        // An unconnected gate has no endpoint to share; a name of its own keeps it apart from other unconnected gates.
        endpoint: kind
            .shares_endpoint()
            .then(|| endpoint.clone().unwrap_or_else(|| format!("{owner}.{}.unconnected", gate.name))),
        tap: kind.listens().then(|| format!("{owner}.{}.peer", gate.name)),
        options: GateOptions::COUNTERPART,
        connections: endpoint.into_iter().map(|endpoint| connection(owner, gate, endpoint, contract.clone())).collect(),
        contract,
    }
}

fn connection(owner: &str, gate: &GatePlan, endpoint: String, contract: String) -> ConnectionPlan {
    let receives = matches!(gate.kind.opposite(), GateKind::Sub | GateKind::Pull);
    ConnectionPlan {
        peer_component: owner.to_owned(),
        peer_gate: gate.name.clone(),
        endpoint,
        contract,
        required: true,
        queue: gate.options.queue,
        when_full: gate.options.when_full,
        max_size: if receives { u64::MAX } else { gate.options.max_size },
        max_age: if receives { None } else { gate.options.max_age },
    }
}
