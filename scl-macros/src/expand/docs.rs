//! The documentation of generated items: what an editor shows on hover.

use super::call::Call;
use super::spec::{codec_text, payload_text};
use scl_topology::topology::{Codec, Component, Gate, GateId, GateKind, GateOptions, Payload, Topology, WhenFull};
use std::time::Duration;

/// The struct's: the component's own words, its gates as a table, its place.
pub(super) fn of_component(call: &Call<'_>, topology: &Topology, component: &Component) -> String {
    let mut doc = component.doc().map(|doc| format!("{doc}\n\n")).unwrap_or_default();
    if component.gates().is_empty() {
        doc.push_str("It has no gates.\n");
    } else {
        doc.push_str("| gate | kind | type | peers |\n|---|---|---|---|\n");
    }
    for &id in component.gates() {
        let gate = topology.gate(id);
        let payload = payload_text(gate.payload());
        let peers = peers(topology, id);
        doc.push_str(&format!("| `{}` | `{}` | `{payload}` | {peers} |\n", gate.name(), gate.kind().word()));
    }
    let place = call.place(component.span());
    format!("{doc}\nThe component `{}` of `{}`, declared at `{place}`.", component.name(), topology.system())
}

/// The field's: kind, type, peers, the options that are not usual, the gate's own words, its place.
pub(super) fn of_gate(call: &Call<'_>, topology: &Topology, id: GateId) -> String {
    let gate = topology.gate(id);
    let mut doc = format!("`{}`: {}.", gate.kind().word(), sentence(gate, &peers(topology, id)));
    if let Some(words) = gate.doc() {
        doc.push_str(&format!("\n\n{words}"));
    }
    let options = options(gate);
    if !options.is_empty() {
        doc.push_str(&format!("\n\nOptions: {}.", options.join(", ")));
    }
    format!("{doc}\n\nDeclared at `{}`.", call.place(gate.span()))
}

fn sentence(gate: &Gate, peers: &str) -> String {
    let message = match gate.payload() {
        Payload::Bytes => "bytes".to_owned(),
        Payload::Message(name) => format!("`{}`", name.dotted()),
        Payload::Exchange { request, reply } => format!("`{}` -> `{}`", request.dotted(), reply.dotted()),
    };
    match gate.kind() {
        GateKind::Pub => format!("publishes {message} to {peers}"),
        GateKind::Sub => format!("subscribes to {message} from {peers}"),
        GateKind::Req => format!("requests {message} of {peers}"),
        GateKind::Rep => format!("replies {message} to {peers}"),
        GateKind::Push => format!("pushes {message} to {peers}"),
        GateKind::Pull => format!("pulls {message} from {peers}"),
    }
}

fn peers(topology: &Topology, id: GateId) -> String {
    let connections = topology.gate(id).connections().iter();
    let peers = connections.map(|&connection| topology.connection(connection).peer_of(id));
    let peers: Vec<String> = peers.map(|peer| format!("`{}`", topology.gate_path(peer))).collect();
    if peers.is_empty() { "nobody".to_owned() } else { peers.join(", ") }
}

/// The options that differ from the default, as in the file.
fn options(gate: &Gate) -> Vec<String> {
    let GateOptions { queue, when_full, backpressure, timeout, share, unconnected_ok } = gate.options();
    let usual_codec = if *gate.payload() == Payload::Bytes { Codec::Raw } else { Codec::Protobuf };
    let when_full_word = match when_full {
        WhenFull::DropOldest => "drop_oldest",
        WhenFull::DropNewest => "drop_newest",
        WhenFull::Wait => "wait",
    };
    let all = [
        (*gate.codec() != usual_codec, format!("`codec: {}`", codec_text(gate.codec()))),
        (*queue != 100, format!("`queue: {queue}`")),
        (*when_full != WhenFull::DropOldest, format!("`when_full: {when_full_word}`")),
        (*backpressure, "`backpressure: true`".to_owned()),
        (*timeout != Duration::from_secs(1), format!("`timeout: {timeout:?}`")),
        (*share, "`share: true`".to_owned()),
        (*unconnected_ok, "`unconnected: ok`".to_owned()),
    ];
    all.into_iter().filter(|(differs, _)| *differs).map(|(_, text)| text).collect()
}
