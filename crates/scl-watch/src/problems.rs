//! What is wrong now, in sentences, the worst first.

use crate::live::Troubles;
use scl_observe::{Activity, ComponentRow, Snapshot};
use scl_plan::SystemPlan;
use std::time::Instant;

/// Returns a sentence for each thing that is wrong.
pub(crate) fn problems_of(plans: &SystemPlan, snapshot: &Snapshot, troubles: &Troubles, now: Instant) -> Vec<String> {
    let mut problems: Vec<(u8, String)> = Vec::new();
    for component in &snapshot.components {
        problems.extend(problem_of_component(plans, snapshot, component));
    }
    for gate in &snapshot.gates {
        let name = gate.name();
        let Some(counts) = troubles.of(&name) else { continue };
        if counts.is_dropping(now) {
            problems.push((2, format!("{name} drops messages: its queue is full ({} so far)", counts.dropped)));
        }
        if counts.is_missing(now) {
            problems.push((3, format!("{name} misses messages that were due ({} so far)", counts.missed)));
        }
    }
    problems.sort_by_key(|(rank, _)| *rank);
    problems.into_iter().map(|(_, text)| text).collect()
}

fn problem_of_component(plans: &SystemPlan, snapshot: &Snapshot, component: &ComponentRow) -> Option<(u8, String)> {
    let name = &component.name;
    match component.activity {
        Activity::Dead => Some((0, format!("{name} was killed or has crashed"))),
        Activity::Hangs(silence) => Some((1, format!("{name} hangs: no figures for {} s", silence.as_secs()))),
        Activity::Waiting => Some((4, format!("{name} waits for {}", missing_peers(plans, snapshot, name)))),
        Activity::Running | Activity::Ready | Activity::Stopped => None,
    }
}

/// The peers that a component waits for.
fn missing_peers(plans: &SystemPlan, snapshot: &Snapshot, component: &str) -> String {
    let required = |gate: &str, peer: &str| {
        let gate = plans.component(component).ok().and_then(|plan| plan.gate(gate));
        let mut connections = gate.into_iter().flat_map(|gate| &gate.connections);
        connections.any(|it| it.required && format!("{}.{}", it.peer_component, it.peer_gate) == peer)
    };
    let gates = snapshot.gates.iter().filter(|gate| gate.component == component);
    let missing = gates.flat_map(|gate| {
        let unconnected = gate.connections.iter().filter(|it| it.connected == Some(false));
        unconnected.filter(|it| required(&gate.gate, &it.peer)).map(|it| it.peer.as_str())
    });
    let missing: Vec<&str> = missing.collect();
    match missing.as_slice() {
        [] => "its peers".to_owned(),
        [first, second, third, rest @ ..] if !rest.is_empty() => {
            format!("{first}, {second}, {third} and {} more", rest.len())
        }
        few => few.join(", "),
    }
}
