//! The differences between two topologies, part by part.

use super::Side;
use super::facts::{Fact, component_facts, connection_facts, connection_name, gate_facts};
use scl_topology::topology::Topology;

/// One part that differs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Change {
    /// Which sort of part: `component`, `gate`, `connection`, `system`.
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

/// A part by its name, with what there is to say about it.
type Part = (String, Vec<Fact>);

/// Every difference: the system, then components, gates and connections, each in file order, what is gone first.
pub(super) fn find_changes(old: &Side, new: &Side) -> Vec<Change> {
    let system = |side: &Side| vec![(String::new(), vec![("name", side.system.clone())])];
    let mut changes = compare("system", &system(old), &system(new));
    let (old, new) = (&old.topology, &new.topology);
    changes.extend(compare("component", &components(old), &components(new)));
    changes.extend(compare("gate", &gates(old), &gates(new)));
    changes.extend(compare("connection", &connections(old), &connections(new)));
    changes
}

fn components(topology: &Topology) -> Vec<Part> {
    topology.components().map(|(_, it)| (it.name().to_owned(), component_facts(it))).collect()
}

fn gates(topology: &Topology) -> Vec<Part> {
    let gates = topology.components().flat_map(|(_, component)| component.gates());
    gates.map(|&id| (topology.gate_path(id), gate_facts(topology.gate(id)))).collect()
}

fn connections(topology: &Topology) -> Vec<Part> {
    topology.connections().map(|(id, _)| (connection_name(topology, id), connection_facts(topology, id))).collect()
}

fn compare(part: &'static str, old: &[Part], new: &[Part]) -> Vec<Change> {
    let change = |name: &String, how| Change { part, name: name.clone(), how };
    let removed = old.iter().filter(|(name, _)| find(new, name).is_none());
    let mut changes: Vec<Change> = removed.map(|(name, facts)| change(name, How::Removed(facts.clone()))).collect();
    for (name, facts) in new {
        match find(old, name) {
            None => changes.push(change(name, How::Added(facts.clone()))),
            Some(before) if before != facts => changes.push(change(name, How::Changed(differing(before, facts)))),
            Some(_) => {}
        }
    }
    changes
}

fn find<'p>(parts: &'p [Part], name: &str) -> Option<&'p Vec<Fact>> {
    parts.iter().find(|(other, _)| other == name).map(|(_, facts)| facts)
}

fn differing(old: &[Fact], new: &[Fact]) -> Vec<(&'static str, String, String)> {
    let value = |facts: &[Fact], key: &str| facts.iter().find(|fact| fact.0 == key).map(|fact| fact.1.clone());
    let gone = old.iter().filter(|(key, _)| value(new, key).is_none());
    let keys = new.iter().chain(gone).map(|(key, _)| *key);
    keys.map(|key| (key, value(old, key).unwrap_or_default(), value(new, key).unwrap_or_default()))
        .filter(|(_, before, after)| before != after)
        .collect()
}
