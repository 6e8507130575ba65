//! Which components must be rebuilt: those of which something differs that is compiled into them.

use super::Side;
use super::facts::{Fact, compiled_gate_facts, connection_facts, connection_name, queue_facts, size_fact};
use scl_topology::topology::{Component, GateId, Topology};

/// A component and why it must be rebuilt.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Rebuild {
    /// Its name.
    pub(super) component: String,
    /// At least one reason.
    pub(super) reasons: Vec<String>,
}

/// The components of the new topology that must be built, in file order.
pub(super) fn find_rebuilds(old: &Side, new: &Side) -> Vec<Rebuild> {
    let rebuild = |component: &Component| Rebuild {
        component: component.name().to_owned(),
        reasons: match old.topology.components().find(|(_, before)| before.name() == component.name()) {
            None => vec!["it is new".to_owned()],
            Some((_, before)) => reasons(&compiled(old, before), &compiled(new, component)),
        },
    };
    let rebuilds = new.topology.components().map(|(_, component)| rebuild(component));
    rebuilds.filter(|rebuild| !rebuild.reasons.is_empty()).collect()
}

/// Parts of a program by name, with all that the compiler puts into it about them.
type Compiled = Vec<(String, Vec<Fact>)>;

fn compiled(side: &Side, component: &Component) -> Compiled {
    let topology = &side.topology;
    let mut parts = vec![("the system's name".to_owned(), vec![("name", side.system.clone())])];
    for &id in component.gates() {
        let gate = topology.gate(id);
        parts.push((format!("gate `{}`", gate.name()), compiled_gate_facts(gate)));
        parts.extend(links(topology, id));
    }
    parts
}

/// The connections of a gate as its program knows them.
fn links(topology: &Topology, gate: GateId) -> Compiled {
    let connections = topology.gate(gate).connections().iter();
    connections
        .map(|&id| {
            let connection = topology.connection(id);
            let peer_gate = topology.gate(connection.peer_of(gate));
            let peer = topology.component(peer_gate.component());
            let mut facts = connection_facts(topology, id);
            // The sender keeps the queue of the receiver.
            facts.extend(queue_facts(topology.gate(connection.sink()).options()));
            // The sender refuses what the peer does not accept.
            facts.push(size_fact(peer_gate.options()));
            facts.push(("optional", peer.optional().to_string()));
            (format!("connection `{}`", connection_name(topology, id)), facts)
        })
        .collect()
}

fn reasons(old: &Compiled, new: &Compiled) -> Vec<String> {
    let find = |parts: &Compiled, name: &String| parts.iter().find(|part| part.0 == *name).cloned();
    let gone = old.iter().filter(|(name, _)| find(new, name).is_none());
    let mut reasons: Vec<String> = gone.map(|(name, _)| format!("{name} is gone")).collect();
    for part in new {
        match find(old, &part.0) {
            None => reasons.push(format!("{} is new", part.0)),
            Some(before) if before != *part => reasons.push(format!("{} differs", part.0)),
            Some(_) => {}
        }
    }
    // A component that is connected to itself has the connection at two gates.
    reasons.dedup();
    reasons
}
