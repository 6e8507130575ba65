//! What there is to say about the parts of a topology, as pairs of key and value.

use scl_topology::resolve::{contract, endpoint};
use scl_topology::size;
use scl_topology::topology::{Component, ConnectionId, Gate, GateKind, GateOptions, Topology};

/// A key of the topology file, or a word for what follows from it, and its value.
pub(super) type Fact = (&'static str, String);

/// Of a component, without its gates.
pub(super) fn component_facts(component: &Component) -> Vec<Fact> {
    vec![("optional", component.optional().to_string()), ("doc", doc(component.doc()))]
}

/// Of a gate, without its connections.
pub(super) fn gate_facts(gate: &Gate) -> Vec<Fact> {
    let mut facts = compiled_gate_facts(gate);
    facts.extend([
        ("share", gate.options().share.to_string()),
        ("unconnected", gate.options().unconnected_ok.to_string()),
        ("doc", doc(gate.doc())),
    ]);
    facts
}

/// Of a gate, what is compiled into its program.
pub(super) fn compiled_gate_facts(gate: &Gate) -> Vec<Fact> {
    let GateOptions { timeout, backpressure, .. } = gate.options();
    let mut facts = vec![
        ("kind", gate.kind().word().to_owned()),
        ("type", gate.payload().to_string()),
        ("codec", gate.codec().word().to_owned()),
    ];
    // Options that the kind does not have would differ only because the kind does.
    match gate.kind() {
        GateKind::Sub | GateKind::Pull => facts.extend(queue_facts(gate.options())),
        GateKind::Pub | GateKind::Push => facts.push(("backpressure", backpressure.to_string())),
        GateKind::Req => facts.push(("timeout", format!("{timeout:?}"))),
        GateKind::Rep => {}
    }
    if !matches!(gate.kind(), GateKind::Pub | GateKind::Push) {
        facts.push(size_fact(gate.options()));
    }
    facts
}

/// Of a connection, what both ends must agree on.
pub(super) fn connection_facts(topology: &Topology, id: ConnectionId) -> Vec<Fact> {
    vec![("contract", contract(topology, id)), ("socket", endpoint(topology, id))]
}

/// The queue of a receiving gate, which its senders keep.
pub(super) fn queue_facts(options: &GateOptions) -> [Fact; 2] {
    [("queue", options.queue.to_string()), ("when_full", options.when_full.word().to_owned())]
}

/// The longest message that a gate accepts, which its peers know.
pub(super) fn size_fact(options: &GateOptions) -> Fact {
    ("max_size", size::text(options.max_size))
}

/// `sensor.measurements -> controller.sensor`: two gates are connected at most once, so it is a name.
pub(super) fn connection_name(topology: &Topology, id: ConnectionId) -> String {
    let connection = topology.connection(id);
    format!("{} -> {}", topology.gate_path(connection.source()), topology.gate_path(connection.sink()))
}

fn doc(doc: Option<&str>) -> String {
    doc.map_or_else(|| "none".to_owned(), |text| format!("{text:?}"))
}
