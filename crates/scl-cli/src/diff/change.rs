//! The differences between two topologies, part by part.

use super::Side;
use super::connections::connections_of;
use super::facts::{Fact, component_facts, connection_facts, gate_facts, parameter_facts};
use scl_plan::Plan;
use std::collections::HashMap;

/// One part that differs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Change {
    /// Which sort of part: `component`, `parameter`, `gate`, `connection`, `system`, `message`, `enum`.
    pub(super) part: &'static str,
    /// Its name.
    pub(super) name: String,
    /// What happened to it.
    pub(super) how: How,
}

/// What happened to a part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum How {
    /// It is new.
    Added(Vec<Fact>),
    /// It is gone.
    Removed(Vec<Fact>),
    /// These facts differ: key, old value, new value. A value is empty where there is none.
    Changed(Vec<(&'static str, String, String)>),
}

/// A part: its name and its facts.
type Part = (String, Vec<Fact>);

/// Returns every difference: the system, then components, parameters, gates and connections. For each of these, removed
/// parts come first, then the others in the order of the new file; connections are in the order of their sending gates.
pub(super) fn find_changes(old: &Side, new: &Side) -> Vec<Change> {
    let system = |side: &Side| vec![(String::new(), vec![("name", side.system.clone())])];
    let mut changes = compare("system", &system(old), &system(new));
    changes.extend(compare("component", &components(old), &components(new)));
    changes.extend(compare("parameter", &parameters(old), &parameters(new)));
    changes.extend(compare("gate", &gates(old), &gates(new)));
    changes.extend(compare("connection", &connections(old), &connections(new)));
    changes
}

fn components(side: &Side) -> Vec<Part> {
    side.topology.components().map(|(_, it)| (it.name().to_owned(), component_facts(it))).collect()
}

fn parameters(side: &Side) -> Vec<Part> {
    let of = |plan: &Plan| {
        let facts = plan.parameters.iter().map(|it| (format!("{}.{}", plan.component, it.name), parameter_facts(it)));
        facts.collect::<Vec<_>>()
    };
    side.plan.components.iter().flat_map(of).collect()
}

fn gates(side: &Side) -> Vec<Part> {
    let declared = side.topology.components().flat_map(|(_, component)| component.gates());
    let planned = side.plan.components.iter().flat_map(|plan| &plan.gates);
    let gates = declared.zip(planned);
    gates.map(|(&id, plan)| (side.topology.gate_path(id), gate_facts(side.topology.gate(id), plan))).collect()
}

fn connections(side: &Side) -> Vec<Part> {
    connections_of(&side.plan).map(|it| (it.name(), connection_facts(it.plan))).collect()
}

fn compare(part: &'static str, old: &[Part], new: &[Part]) -> Vec<Change> {
    let change = |name: &String, how| Change { part, name: name.clone(), how };
    let (before, after) = (by_name(old), by_name(new));
    let removed = old.iter().filter(|(name, _)| !after.contains_key(name.as_str()));
    let mut changes: Vec<Change> = removed.map(|(name, facts)| change(name, How::Removed(facts.clone()))).collect();
    for (name, facts) in new {
        match before.get(name.as_str()) {
            None => changes.push(change(name, How::Added(facts.clone()))),
            Some(&before) if before != facts => changes.push(change(name, How::Changed(differing(before, facts)))),
            Some(_) => {}
        }
    }
    changes
}

fn by_name(parts: &[Part]) -> HashMap<&str, &Vec<Fact>> {
    parts.iter().map(|(name, facts)| (name.as_str(), facts)).collect()
}

fn differing(old: &[Fact], new: &[Fact]) -> Vec<(&'static str, String, String)> {
    let value = |facts: &[Fact], key: &str| facts.iter().find(|fact| fact.0 == key).map(|fact| fact.1.clone());
    let gone = old.iter().filter(|(key, _)| value(new, key).is_none());
    let keys = new.iter().chain(gone).map(|(key, _)| *key);
    keys.map(|key| (key, value(old, key).unwrap_or_default(), value(new, key).unwrap_or_default()))
        .filter(|(_, before, after)| before != after)
        .collect()
}
