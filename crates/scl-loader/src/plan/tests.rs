//! The plans of every topology of this project: both ends agree, and texts come back, whole or damaged.

use crate::{Loaded, Request, load};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use scl_plan::{ConnectionPlan, GateKind, Payload, PlanError, SystemPlan, WhenFull};
use std::path::Path;
use std::sync::LazyLock;
use std::time::Duration;

/// The topologies of the workspace without errors, one of each family.
const TOPOLOGIES: [&str; 20] = [
    "bench/allocations.yaml",
    "bench/fanout.yaml",
    "bench/fresh.yaml",
    "bench/one_way.yaml",
    "bench/restart.yaml",
    "bench/roundtrip.yaml",
    "examples/quickstart/topology.yaml",
    "crates/scl-topology/tests/files/listing_1.yaml",
    "crates/scl-topology/tests/files/system.yaml",
    "scl/doc/rover.yaml",
    "scl/tests/untyped.yaml",
    "tests/topologies/bounded.yaml",
    "tests/topologies/exits.yaml",
    "tests/topologies/fresh.yaml",
    "tests/topologies/limits.yaml",
    "tests/topologies/shapes/extended.yaml",
    "tests/topologies/six_kinds.yaml",
    "tests/topologies/sizes.yaml",
    "tests/topologies/ten_gates.yaml",
    "tests/topologies/twins.yaml",
];

static SYSTEMS: LazyLock<Vec<SystemPlan>> = LazyLock::new(|| {
    let plan = |file: &&str| {
        let loaded: Loaded = load(&Request::new(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(file)));
        loaded.system_plan().unwrap_or_else(|| panic!("{file}: {:#?}", loaded.diagnostics))
    };
    TOPOLOGIES.iter().map(plan).collect()
});

#[test]
fn plans_come_back_from_their_text() {
    for system in &*SYSTEMS {
        assert_eq!(SystemPlan::from_json(&system.to_json()).unwrap(), *system);
        for plan in &system.components {
            plan.validate().unwrap();
            plan.counterpart().validate().unwrap();
        }
    }
}

/// Two programs meet only if each end of a connection has the same names for it.
#[test]
fn both_ends_of_a_connection_agree() {
    let mut ends = 0;
    for system in &*SYSTEMS {
        for plan in &system.components {
            for gate in &plan.gates {
                for connection in &gate.connections {
                    let peer = system.component(&connection.peer_component).unwrap();
                    let peer = peer.gate(&connection.peer_gate).unwrap();
                    let back = |it: &&ConnectionPlan| it.peer_component == plan.component && it.peer_gate == gate.name;
                    let back = peer.connections.iter().find(back).unwrap();
                    assert_eq!((&connection.endpoint, &connection.contract), (&back.endpoint, &back.contract));
                    let receives = matches!(gate.kind, GateKind::Sub | GateKind::Pull | GateKind::Rep);
                    let receiver = if receives { gate } else { peer };
                    for end in [connection, back] {
                        assert_eq!((end.queue, end.when_full), (receiver.options.queue, receiver.options.when_full));
                    }
                    assert_eq!(peer.kind, gate.kind.opposite());
                    if gate.kind.shares_endpoint() {
                        assert_eq!(gate.endpoint.as_ref(), Some(&connection.endpoint));
                    }
                    ends += 1;
                }
            }
        }
    }
    assert!(ends > 100, "{ends}");
}

#[test]
fn texts_that_end_early_are_errors() {
    for system in &*SYSTEMS {
        let text = system.to_json();
        // Every byte of one component's plan; of larger texts, a few hundred places.
        for end in (0..text.trim_end().len()).step_by(1 + text.len() / 400) {
            assert!(matches!(SystemPlan::from_json(&text[..end]), Err(PlanError::Syntax(_))), "{end}");
        }
    }
}

proptest! {
    /// Any value that a plan can have comes back, whatever it contains, if the plan makes sense; else that is told.
    #[test]
    fn changed_plans_come_back_or_are_refused(
        (system, component, gate, connection) in any::<(Index, Index, Index, Index)>(),
        (text, other) in any::<(String, Option<String>)>(),
        (queue, max_size, nanoseconds) in any::<(u32, u64, u64)>(),
        kind in select(GateKind::ALL.to_vec()),
        when_full in select(WhenFull::ALL.to_vec()),
        field in 0..12_u8,
    ) {
        let mut plan = system.get(&SYSTEMS).clone();
        let component = component.index(plan.components.len());
        let component = &mut plan.components[component];
        prop_assume!(!component.gates.is_empty());
        let gate = gate.index(component.gates.len());
        let gate = &mut component.gates[gate];
        match field {
            0 => gate.name = text,
            1 => gate.kind = kind,
            2 => gate.payload = other.map_or(Payload::Bytes, Payload::Message),
            3 => gate.payload = Payload::Exchange { request: text, reply: other.unwrap_or_default() },
            4 => gate.codec = text,
            5 => gate.endpoint = other,
            6 => gate.tap = other,
            7 => (gate.options.queue, gate.options.max_size) = (queue, max_size),
            8 => (gate.options.when_full, gate.options.backpressure) = (when_full, queue % 2 == 0),
            9 => gate.options.timeout = Duration::from_nanos(nanoseconds),
            10 => component.declared_at = text,
            _ => {
                prop_assume!(!gate.connections.is_empty());
                let connection = connection.index(gate.connections.len());
                let connection = &mut gate.connections[connection];
                (connection.endpoint, connection.peer_gate) = (text, other.unwrap_or_default());
                (connection.queue, connection.max_size, connection.when_full) = (queue, max_size, when_full);
                connection.required = !connection.required;
            }
        }
        let sensible = plan.components.iter().all(|plan| plan.validate().is_ok());
        match SystemPlan::from_json(&plan.to_json()) {
            Ok(read) => {
                prop_assert!(sensible);
                prop_assert_eq!(read, plan);
            }
            Err(error) => prop_assert!(!sensible && matches!(error, PlanError::Inconsistent { .. }), "{}", error),
        }
    }

    #[test]
    fn damaged_texts_are_plans_or_errors(system: Index, at: Index, length in 0..20_usize, filling in "[\\PC\n]{0,6}") {
        let mut bytes = system.get(&SYSTEMS).to_json().into_bytes();
        let start = at.index(bytes.len());
        let end = (start + length).min(bytes.len());
        bytes.splice(start..end, filling.bytes());
        if let Ok(read) = SystemPlan::from_json(&String::from_utf8_lossy(&bytes)) {
            prop_assert_eq!(SystemPlan::from_json(&read.to_json()).unwrap(), read);
        }
    }
}
