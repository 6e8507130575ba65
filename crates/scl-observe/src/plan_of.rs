//! The plan of a component that is to be played: its own if it announced one, else what follows from its peers' plans.

use crate::component::Component;
use crate::system::System;
use scl_plan::{ConnectionPlan, GateKind, GateOptions, GatePlan, Plan, Schema};
use scl_terminal::Problem;
use scl_text::gate_name::gate_in_file_name;
use std::sync::Arc;

impl System {
    /// Returns the plan of a component: the one that it announces, or left behind when it was killed; else the part
    /// that its running peers know, which is every gate that is connected to one of them.
    ///
    /// # Errors
    /// There is no such component, or neither it nor a peer of it runs.
    pub fn plan_of(&self, component: &str) -> Result<Plan, Problem> {
        let found = self.component(component)?;
        if let Some(plan) = found.plan() {
            return Ok(Plan { schema: self.plan_schema(&found), ..plan.clone() });
        }
        let peers: Vec<Component> = self.components().into_iter().filter(Component::is_running).collect();
        let gates = opposite_gates(component, &peers);
        if gates.is_empty() {
            return Err(Problem::new(format!(
                "nothing is known about the gates of `{component}`: none of its peers runs"
            ))
            .help("name the topology file with `--topology FILE`, or start the peers first"));
        }
        let names_it = |peer: &&Component| {
            peer.gates().iter().flat_map(|gate| &gate.connections).any(|it| it.peer_component == component)
        };
        let schema = peers.iter().filter(names_it).find_map(|peer| self.plan_schema(peer));
        let (system, component) = (self.name().to_owned(), component.to_owned());
        Ok(Plan { system, component, declared_at: String::new(), schema, parameters: Vec::new(), gates })
    }

    fn plan_schema(&self, component: &Component) -> Option<Schema> {
        let hash = component.announcement.as_ref()?.schema.clone()?;
        let descriptors = self.schema_of(component)?;
        Some(Schema { hash, descriptors: Arc::from(&descriptors[..]) })
    }
}

/// The gates of a component as its peers see them, in the order in which they name them.
fn opposite_gates(component: &str, peers: &[Component]) -> Vec<GatePlan> {
    let mut gates: Vec<GatePlan> = Vec::new();
    for peer in peers {
        for gate in peer.gates() {
            for connection in gate.connections.iter().filter(|connection| connection.peer_component == component) {
                let opposite = opposite_gate(component, &peer.name, gate, connection);
                match gates.iter_mut().find(|known| known.name == opposite.name) {
                    Some(known) if known.contract == opposite.contract => {
                        known.connections.extend(opposite.connections)
                    }
                    // The peers were built from different topologies; the first one wins.
                    Some(_) => {}
                    None => gates.push(opposite),
                }
            }
        }
    }
    gates
}

fn opposite_gate(component: &str, peer: &str, gate: &GatePlan, connection: &ConnectionPlan) -> GatePlan {
    let kind = gate.kind.opposite();
    let receives_only = matches!(kind, GateKind::Sub | GateKind::Pull);
    let options = GateOptions {
        queue: if receives_only { connection.queue } else { GateOptions::DEFAULT.queue },
        when_full: connection.when_full,
        max_age: if kind.is_source() { None } else { connection.max_age },
        ..GateOptions::DEFAULT
    };
    GatePlan {
        name: connection.peer_gate.clone(),
        kind,
        payload: gate.payload.clone(),
        codec: gate.codec.clone(),
        declared_at: gate.declared_at.clone(),
        endpoint: kind.shares_endpoint().then(|| connection.endpoint.clone()),
        tap: kind.listens().then(|| format!("{}.tap", gate_in_file_name(component, &connection.peer_gate))),
        contract: connection.contract.clone(),
        connections: vec![ConnectionPlan {
            peer_component: peer.to_owned(),
            peer_gate: gate.name.clone(),
            endpoint: connection.endpoint.clone(),
            contract: connection.contract.clone(),
            // The peer is running.
            required: true,
            queue: connection.queue,
            when_full: connection.when_full,
            max_size: if receives_only { options.max_size } else { gate.options.max_size },
            max_age: connection.max_age,
        }],
        options,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scl::runtime_dir::{Announcement, ComponentState};
    use scl_loader::{Request, load_bytes};
    use scl_plan::Payload;

    const TOPOLOGY: &str = "\
system: rover
components:
  - name: sensor
    gates:
      - measurements: {pub: rover.Measurement, codec: json}
      - log: {push: rover.Event, codec: json}
  - name: controller
    gates:
      - sensor: {sub: rover.Measurement, codec: json, queue: 1, max_size: 1KiB}
      - log: {push: rover.Event, codec: json}
      - commands: {rep: rover.Command -> rover.Status, codec: json}
  - name: display
    gates:
      - sensor: {sub: rover.Measurement, codec: json}
  - name: logger
    gates:
      - events: {pull: rover.Event, codec: json}
  - name: ui
    gates:
      - commands: {req: rover.Command -> rover.Status, codec: json}
connections:
  - [sensor.measurements, controller.sensor]
  - [sensor.measurements, display.sensor]
  - [sensor.log, logger.events]
  - [controller.log, logger.events]
  - [controller.commands, ui.commands]
";

    /// What the topology says about a component and what its peers know is the same, but for its own options.
    #[test]
    fn the_peers_of_a_component_know_its_gates() {
        let system = load_bytes(&Request::new("topology.yaml"), TOPOLOGY.into()).system_plan().unwrap();
        for plan in &system.components {
            let peers: Vec<Component> = system.components.iter().filter(|peer| *peer != plan).map(running).collect();
            let mut known = opposite_gates(&plan.component, &peers);
            known.sort_by_key(|gate| plan.gates.iter().position(|own| own.name == gate.name));
            assert_eq!(facts(&known), facts(&plan.gates), "{}", plan.component);
            let plan = Plan { gates: known, ..plan.clone() };
            plan.validate().unwrap();
        }
    }

    type Facts<'a> = (&'a str, GateKind, &'a Payload, &'a str, &'a Option<String>, &'a Option<String>, &'a str);
    type Connections<'a> = Vec<(&'a str, &'a str, &'a str, &'a str, u32, u64)>;

    fn facts(gates: &[GatePlan]) -> Vec<(Facts<'_>, Connections<'_>)> {
        gates
            .iter()
            .map(|gate| {
                let GatePlan { name, kind, payload, codec, endpoint, tap, contract, connections, .. } = gate;
                let receives_only = matches!(kind, GateKind::Sub | GateKind::Pull);
                let connections = connections.iter().map(|it| {
                    // What it accepts itself, its peers do not need to know.
                    let max_size = if receives_only { 0 } else { it.max_size };
                    (&*it.peer_component, &*it.peer_gate, &*it.endpoint, &*it.contract, it.queue, max_size)
                });
                ((&**name, *kind, payload, &**codec, endpoint, tap, &**contract), connections.collect())
            })
            .collect()
    }

    fn running(plan: &Plan) -> Component {
        let mut announcement = Announcement::of_this_process(plan.component.clone());
        announcement.plan = Some(plan.clone());
        let mut component = Component::stopped(&plan.component);
        component.announcement = Some(announcement);
        component.state = ComponentState::Dead;
        component
    }
}
