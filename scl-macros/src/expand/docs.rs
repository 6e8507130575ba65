//! The documentation of generated items, which editors show on hover.

use super::context::Context;
use scl_topology::grammar::OPTIONS;
use scl_topology::topology::{Codec, Component, Gate, GateId, Payload, Topology};

/// The documentation of a struct: the component's `doc`, its gates as a table, and where it is declared.
pub(super) fn of_component(context: &Context<'_>, topology: &Topology, component: &Component) -> String {
    let mut doc = component.doc().map(|doc| format!("{doc}\n\n")).unwrap_or_default();
    if component.gates().is_empty() {
        doc.push_str("It has no gates.\n");
    } else {
        doc.push_str("| gate | kind | type | peers |\n|---|---|---|---|\n");
    }
    for &id in component.gates() {
        let gate = topology.gate(id);
        let (name, kind, payload) = (gate.name(), gate.kind().word(), gate.payload());
        doc.push_str(&format!("| `{name}` | `{kind}` | `{payload}` | {} |\n", peers(topology, id)));
    }
    let location = context.location(component.span());
    format!("{doc}\nThe component `{}` of `{}`, declared at `{location}`.", component.name(), topology.system())
}

/// The documentation of a field: kind, type, peers, the gate's `doc`, unusual options, and where it is declared.
pub(super) fn of_gate(context: &Context<'_>, topology: &Topology, id: GateId) -> String {
    let gate = topology.gate(id);
    let mut doc = format!("`{}`: {}.", gate.kind().word(), sentence(gate, &peers(topology, id)));
    if let Some(words) = gate.doc() {
        doc.push_str(&format!("\n\n{words}"));
    }
    let options = options(gate);
    if !options.is_empty() {
        doc.push_str(&format!("\n\nOptions: {}.", options.join(", ")));
    }
    format!("{doc}\n\nDeclared at `{}`.", context.location(gate.span()))
}

fn sentence(gate: &Gate, peers: &str) -> String {
    let message = match gate.payload() {
        Payload::Bytes => "bytes".to_owned(),
        Payload::Message(name) => format!("`{}`", name.dotted()),
        Payload::Exchange { request, reply } => format!("`{}` -> `{}`", request.dotted(), reply.dotted()),
    };
    gate.kind().sentence(&message, peers)
}

fn peers(topology: &Topology, id: GateId) -> String {
    let connections = topology.gate(id).connections().iter();
    let peers = connections.map(|&connection| topology.connection(connection).peer_of(id));
    let peers: Vec<String> = peers.map(|peer| format!("`{}`", topology.gate_path(peer))).collect();
    if peers.is_empty() { "no peer".to_owned() } else { peers.join(", ") }
}

/// The options that differ from their defaults, as in the file.
fn options(gate: &Gate) -> Vec<String> {
    let default_codec = if *gate.payload() == Payload::Bytes { Codec::Raw } else { Codec::DEFAULT };
    let codec = (*gate.codec() != default_codec).then(|| ("codec", gate.codec().word().to_owned()));
    let others = OPTIONS.iter().filter_map(|option| {
        let value = option.get(gate.options()).filter(|value| option.default().as_ref() != Some(value))?;
        Some((option.key, value))
    });
    codec.into_iter().chain(others).map(|(key, value)| format!("`{key}: {value}`")).collect()
}
