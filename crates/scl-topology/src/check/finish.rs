//! Turns a draft without errors into the topology.

use super::draft::{Draft, DraftGate};
use super::parameter::Parameters;
use crate::grammar;
use crate::rust_name::{component_type, gate_field};
use crate::topology::{
    Codec, Component, ComponentId, Connection, ConnectionId, Gate, GateId, Kind, KindId, Payload, Topology,
};

/// Creates the topology. Returns `None` if a part of the draft has been rejected, which is reported already.
pub(super) fn finish(
    draft: &Draft<'_>,
    parameters: &Parameters,
    system: String,
    codec: &Codec,
    connection_room: usize,
) -> Option<Topology> {
    let connections: Vec<Connection> = draft.links.iter().map(connection).collect::<Option<_>>()?;
    let mut gates: Vec<Gate> = draft.gates.iter().map(|gate| finish_gate(gate, codec)).collect::<Option<_>>()?;
    for (at, connection) in connections.iter().enumerate() {
        for end in [connection.source, connection.sink] {
            gates[end.0 as usize].connections.push(ConnectionId(at as u32));
        }
    }
    let components = draft.components.iter().enumerate().map(|(at, component)| Component {
        name: component.model.name.value.clone(),
        rust_name: component_type(&component.model.name.value),
        doc: component.model.doc.as_ref().map(|doc| doc.value.clone()),
        optional: component.model.optional.unwrap_or(false),
        memory: component.model.memory.as_ref().and_then(|memory| grammar::memory(&memory.value).ok()),
        span: component.model.name.span,
        kind: component.model.of.map(|kind| KindId(kind as u32)),
        parameters: parameters.of(at, component.model.of),
        gates: component.gates.iter().map(|&gate| GateId(gate as u32)).collect(),
    });
    let components = components.collect();
    let kinds = finish_kinds(draft);
    Some(Topology { system, kinds, components, gates, connections, connection_room })
}

fn finish_kinds(draft: &Draft<'_>) -> Vec<Kind> {
    let kinds = draft.model.kinds.iter().map(|kind| Kind {
        name: kind.name.value.clone(),
        rust_name: component_type(&kind.name.value),
        doc: kind.doc.as_ref().map(|doc| doc.value.clone()),
        span: kind.name.span,
        components: Vec::new(),
    });
    let mut kinds: Vec<Kind> = kinds.collect();
    for (at, component) in draft.components.iter().enumerate() {
        if let Some(kind) = component.model.of {
            kinds[kind].components.push(ComponentId(at as u32));
        }
    }
    kinds
}

fn connection(link: &super::draft::Link<'_>) -> Option<Connection> {
    let (source, sink) = link.flow?;
    Some(Connection { source: GateId(source as u32), sink: GateId(sink as u32), span: link.model.span })
}

fn finish_gate(gate: &DraftGate<'_>, default_codec: &Codec) -> Option<Gate> {
    let payload = gate.payload.clone()?;
    let codec = match (&payload, &gate.codec) {
        (Payload::Bytes, _) => Codec::RAW,
        (_, Some(codec)) => codec.value.clone(),
        (_, None) => default_codec.clone(),
    };
    Some(Gate {
        component: ComponentId(gate.component as u32),
        name: gate.model.name.value.clone(),
        rust_name: gate_field(&gate.model.name.value),
        kind: gate.kind?,
        payload,
        codec,
        options: gate.options.clone(),
        doc: gate.option("doc").map(|doc| doc.value.value.clone()),
        span: gate.model.name.span,
        connections: Vec::new(),
    })
}
