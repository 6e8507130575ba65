//! The facts about the parts of a topology, as pairs of key and value.

use scl_plan::{ConnectionPlan, GatePlan, ParameterPlan};
use scl_text::size;
use scl_topology::grammar::OPTIONS;
use scl_topology::topology::{Component, Gate};

/// A key of the topology file, or a word for something derived from it, and its value.
pub(super) type Fact = (&'static str, String);

/// The facts about a component, without its gates.
pub(super) fn component_facts(component: &Component) -> Vec<Fact> {
    vec![
        ("optional", component.optional().to_string()),
        ("memory", component.memory().map_or_else(|| "no bound".to_owned(), size::text)),
        ("doc", doc(component.doc())),
    ]
}

/// The facts about a parameter.
pub(super) fn parameter_facts(parameter: &ParameterPlan) -> Vec<Fact> {
    let ParameterPlan { kind, default, range, unit, doc, live, .. } = parameter;
    let text = |text: Option<&str>| text.unwrap_or("none").to_owned();
    let range = range.as_ref().map(|(least, largest)| format!("{least} to {largest}"));
    vec![
        ("type", kind.to_string()),
        ("default", text(default.as_deref())),
        ("range", text(range.as_deref())),
        ("unit", text(unit.as_deref())),
        ("live", live.to_string()),
        ("doc", self::doc(doc.as_deref())),
    ]
}

/// The facts about a gate, without its connections: those in its plan, and those that only the topology file has.
pub(super) fn gate_facts(gate: &Gate, plan: &GatePlan) -> Vec<Fact> {
    let mut facts =
        vec![("kind", plan.kind.word().to_owned()), ("type", plan.payload.to_string()), ("codec", plan.codec.clone())];
    // Skip options that do not apply to this kind: they would differ only because the kind does.
    let options = OPTIONS.iter().filter(|option| option.fits(gate.kind()) && !option.is_text());
    facts.extend(options.map(|option| (option.key, option.get(gate.options()).unwrap_or_else(|| "none".to_owned()))));
    facts.push(("doc", doc(gate.doc())));
    facts
}

/// What both ends of a connection must agree on.
pub(super) fn connection_facts(connection: &ConnectionPlan) -> Vec<Fact> {
    vec![("contract", connection.contract.clone()), ("socket", connection.endpoint.clone())]
}

fn doc(doc: Option<&str>) -> String {
    doc.map_or_else(|| "none".to_owned(), |text| format!("{text:?}"))
}
