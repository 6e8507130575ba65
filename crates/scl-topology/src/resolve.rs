//! The plan of a component: everything its program needs to run, from the checked topology.
//!
//! Gates find each other by names that this stage determines: contracts and the names of sockets. A contract is a short
//! hash of what two ends must agree on: pattern, types, codec. It is part of the name of the socket, so programs that
//! were built from different contracts never connect. Names of gates, options and other parts of the file do not change
//! it.

mod contract;
mod socket_name;

pub(crate) use socket_name::shortened;

use crate::fingerprint;
use crate::source::Span;
use crate::topology::{ComponentId, ConnectionId, GateId, GateKind, Parameter, Payload, Topology};
use contract::{contract, gate_contract};
use scl_plan::{ConnectionPlan, GatePlan, ParameterPlan, Plan};
use socket_name::{endpoint, gate_endpoint, tap_endpoint};

/// Length of a contract, in characters.
pub const CONTRACT_LENGTH: usize = fingerprint::SHORT_LENGTH;

/// The ending of the socket name of a tap.
pub(crate) const TAP: &str = ".tap";

/// The plan of one component. `location` tells where a declaration stands, for example `topology.yaml:4:11`.
///
/// Which protobuf messages the component uses is not known here: [`Plan::schema`] is left empty.
pub fn resolve(topology: &Topology, component: ComponentId, location: &dyn Fn(Span) -> String) -> Plan {
    let component = topology.component(component);
    Plan {
        system: topology.system().to_owned(),
        component: component.name().to_owned(),
        declared_at: location(component.span()),
        schema: None,
        parameters: component.parameters().iter().map(|it| resolve_parameter(it, location)).collect(),
        gates: component.gates().iter().map(|&gate| resolve_gate(topology, gate, location)).collect(),
    }
}

fn resolve_parameter(parameter: &Parameter, location: &dyn Fn(Span) -> String) -> ParameterPlan {
    ParameterPlan { declared_at: location(parameter.span()).into(), ..parameter.declared().clone() }
}

fn resolve_gate(topology: &Topology, id: GateId, location: &dyn Fn(Span) -> String) -> GatePlan {
    let gate = topology.gate(id);
    GatePlan {
        name: gate.name().to_owned(),
        kind: gate.kind(),
        payload: payload(gate.payload()),
        codec: gate.codec().word().to_owned(),
        declared_at: location(gate.span()),
        endpoint: gate_endpoint(topology, id),
        tap: tap_endpoint(topology, id),
        contract: gate_contract(topology, id),
        options: gate.options().program.clone(),
        connections: gate
            .connections()
            .iter()
            .map(|&connection| resolve_connection(topology, id, connection))
            .collect(),
    }
}

fn resolve_connection(topology: &Topology, gate: GateId, id: ConnectionId) -> ConnectionPlan {
    let connection = topology.connection(id);
    let peer = topology.gate(connection.peer_of(gate));
    let owner = topology.component(peer.component());
    let receiver = topology.gate(connection.sink()).options();
    ConnectionPlan {
        peer_component: owner.name().to_owned(),
        peer_gate: peer.name().to_owned(),
        endpoint: endpoint(topology, id),
        contract: contract(topology, id),
        required: !owner.optional(),
        queue: receiver.queue,
        when_full: receiver.when_full,
        max_size: max_size(topology, gate, id),
        max_age: receiver.max_age,
    }
}

/// The longest message that the peer accepts from a gate. `sub` and `pull` send nothing, so theirs is their own limit.
fn max_size(topology: &Topology, gate: GateId, id: ConnectionId) -> u64 {
    let receiver = match topology.gate(gate).kind() {
        GateKind::Sub | GateKind::Pull => gate,
        GateKind::Pub | GateKind::Push | GateKind::Req | GateKind::Rep => topology.connection(id).peer_of(gate),
    };
    topology.gate(receiver).options().max_size
}

fn payload(payload: &Payload) -> scl_plan::Payload {
    match payload {
        Payload::Bytes => scl_plan::Payload::Bytes,
        Payload::Message(name) => scl_plan::Payload::Message(name.dotted().to_owned()),
        Payload::Exchange { request, reply } => {
            scl_plan::Payload::Exchange { request: request.dotted().to_owned(), reply: reply.dotted().to_owned() }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::testing::topology;
    use crate::socket_paths::SocketPaths;

    const FILE: &str = "components:
  - name: sensor
    gates:
      - fix: {pub: nav.Fix, codec: json}
      - work: {push: nav.Job}
      - ask: {req: A -> B}
  - name: pilot
    gates:
      - gps: {sub: nav.Fix, queue: 1}
      - jobs: pull
      - orders: {rep: A -> B}
  - name: other
    gates:
      - fix: sub
      - work: push
connections:
  - [sensor.fix, pilot.gps]
  - [pilot.jobs, sensor.work]
  - [sensor.ask, pilot.orders]
  - [other.fix, sensor.fix]
  - [other.work, pilot.jobs]
";

    fn endpoints(yaml: &str) -> Vec<String> {
        let topology = topology(yaml);
        topology.connections().map(|(id, _)| endpoint(&topology, id)).collect()
    }

    #[test]
    fn sockets_are_named_after_their_gates() {
        assert_eq!(
            endpoints(FILE),
            [
                "sensor.fix--pilot.gps.5eyd5c3s",
                "pilot.jobs.26t2nsae",
                "pilot.orders.yrvcf33f",
                "sensor.fix--other.fix.5eyd5c3s",
                "pilot.jobs.26t2nsae",
            ]
        );
    }

    #[test]
    fn gates_have_their_own_sockets_by_kind() {
        let topology = topology(FILE);
        let gates = || topology.components().flat_map(|(_, component)| component.gates());
        let own: Vec<_> = gates().filter_map(|&gate| gate_endpoint(&topology, gate)).collect();
        assert_eq!(own, ["pilot.jobs.26t2nsae", "pilot.orders.yrvcf33f"]);
        let taps: Vec<_> = gates().filter_map(|&gate| tap_endpoint(&topology, gate)).collect();
        assert_eq!(taps, ["sensor.fix.tap", "pilot.jobs.tap", "pilot.orders.tap"]);
    }

    #[test]
    fn contracts_change_with_what_they_are_about_only() {
        let contracts = |yaml: &str| {
            let topology = topology(yaml);
            topology.connections().map(|(id, _)| contract(&topology, id)).collect::<Vec<_>>()
        };
        let before = contracts(FILE);
        let same = [
            ("sensor", "probe"),
            ("queue: 1", "queue: 7"),
            ("gates:", "doc: Text.\n    gates:"),
            ("work: push\n", "work: push\n      - more: pub\n"),
        ];
        for (from, to) in same {
            assert_eq!(contracts(&FILE.replace(from, to)), before, "{from} to {to}");
        }
        for (from, to, changed) in
            [("nav.Fix", "nav.Place", [0, 3]), ("nav.Job", "Job", [1, 4]), ("json", "cbor", [0, 3])]
        {
            let after = contracts(&FILE.replace(from, to));
            let differ: Vec<usize> = (0..5).filter(|&at| after[at] != before[at]).collect();
            assert_eq!(differ, changed, "{from} to {to}");
        }
    }

    #[test]
    fn request_and_reply_are_not_interchangeable() {
        let swapped = FILE.replace("A -> B", "B -> A");
        assert_ne!(endpoints(FILE)[2], endpoints(&swapped)[2]);
    }

    #[test]
    fn long_names_fit_into_the_path_and_stay_apart() {
        const SYSTEM: &str = "twenty_characters_ok";
        let long = "a_name_that_is_a_little_longer_than";
        let yaml = FILE.replace("pilot", &format!("{long}_one")).replace("other", &format!("{long}_two"));
        let yaml = format!("system: {SYSTEM}\n{yaml}");
        let names = endpoints(&yaml);
        let paths = SocketPaths::example();
        let room = paths.limit - paths.folder(SYSTEM).len();
        assert!(names.iter().all(|name| name.len() <= room), "{names:?}");
        assert!(names[0].starts_with("sensor.fix--") && names[0].contains('~'), "{names:?}");
        assert_ne!(names[0], names[3]);
        assert_eq!(names[0].rsplit('.').next(), endpoints(FILE)[0].rsplit('.').next());
    }
}
