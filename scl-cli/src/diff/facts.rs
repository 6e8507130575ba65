//! The facts about the parts of a topology, as pairs of key and value.

use scl_plan::{ConnectionPlan, GateKind, GatePlan};
use scl_topology::size;
use scl_topology::topology::{Component, Gate};

/// A key of the topology file, or a word for what follows from it, and its value.
pub(super) type Fact = (&'static str, String);

/// The facts about a component, without its gates.
pub(super) fn component_facts(component: &Component) -> Vec<Fact> {
    vec![("optional", component.optional().to_string()), ("doc", doc(component.doc()))]
}

/// The facts about a gate, without its connections: those of its plan, and those that no program contains.
pub(super) fn gate_facts(gate: &Gate, plan: &GatePlan) -> Vec<Fact> {
    let mut facts =
        vec![("kind", plan.kind.word().to_owned()), ("type", plan.payload.to_string()), ("codec", plan.codec.clone())];
    // Options that the kind does not have would differ only because the kind does.
    match plan.kind {
        GateKind::Sub | GateKind::Pull => {
            facts.extend([("queue", plan.queue.to_string()), ("when_full", plan.when_full.word().to_owned())]);
        }
        GateKind::Pub | GateKind::Push => facts.push(("backpressure", plan.backpressure.to_string())),
        GateKind::Req => facts.push(("timeout", format!("{:?}", plan.timeout))),
        GateKind::Rep => {}
    }
    if !matches!(plan.kind, GateKind::Pub | GateKind::Push) {
        facts.push(("max_size", size::text(plan.max_size)));
    }
    facts.extend([
        ("share", gate.options().share.to_string()),
        ("unconnected", gate.options().unconnected_ok.to_string()),
        ("doc", doc(gate.doc())),
    ]);
    facts
}

/// What both ends of a connection must agree on.
pub(super) fn connection_facts(connection: &ConnectionPlan) -> Vec<Fact> {
    vec![("contract", connection.contract.clone()), ("socket", connection.endpoint.clone())]
}

fn doc(doc: Option<&str>) -> String {
    doc.map_or_else(|| "none".to_owned(), |text| format!("{text:?}"))
}
