//! What the runtime must know of a component, as a constant.

use super::call::Call;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use scl_topology::resolve;
use scl_topology::topology::{Codec, Component, ConnectionId, GateId, GateKind, Payload, Topology, WhenFull};
use std::time::Duration;

/// A `ComponentSpec { .. }`.
pub(super) fn expand_spec(call: &Call<'_>, topology: &Topology, component: &Component) -> TokenStream {
    let private = &call.private;
    let (system, name) = (topology.system(), component.name());
    let place = call.place(component.span());
    let gates = component.gates().iter().map(|&id| expand_gate(call, topology, id));
    quote! {
        #private::ComponentSpec { system: #system, name: #name, place: #place, gates: &[#(#gates),*] }
    }
}

fn expand_gate(call: &Call<'_>, topology: &Topology, id: GateId) -> TokenStream {
    let private = &call.private;
    let gate = topology.gate(id);
    let options = gate.options();
    let name = gate.name();
    let kind = expand_kind(private, gate.kind());
    let payload = payload_text(gate.payload());
    let codec = codec_text(gate.codec());
    let place = call.place(gate.span());
    let endpoint = resolve::gate_endpoint(topology, id).unwrap_or_default();
    let queue = options.queue;
    let when_full = expand_when_full(private, options.when_full);
    let backpressure = options.backpressure;
    let timeout = expand_duration(private, options.timeout);
    let links = gate.connections().iter().map(|&connection| expand_link(call, topology, id, connection));
    quote! {
        #private::GateSpec {
            name: #name, kind: #kind, payload: #payload, codec: #codec, place: #place, endpoint: #endpoint,
            queue: #queue, when_full: #when_full, backpressure: #backpressure, timeout: #timeout,
            links: &[#(#links),*],
        }
    }
}

fn expand_link(call: &Call<'_>, topology: &Topology, gate: GateId, id: ConnectionId) -> TokenStream {
    let private = &call.private;
    let connection = topology.connection(id);
    let peer = topology.gate(connection.peer_of(gate));
    let owner = topology.component(peer.component());
    let (peer_component, peer_gate) = (owner.name(), peer.name());
    let endpoint = resolve::endpoint(topology, id);
    let contract = resolve::contract(topology, id);
    let required = !owner.optional();
    let receiver = topology.gate(connection.sink()).options();
    let queue = receiver.queue;
    let when_full = expand_when_full(private, receiver.when_full);
    quote! {
        #private::LinkSpec {
            peer_component: #peer_component, peer_gate: #peer_gate, endpoint: #endpoint, contract: #contract,
            required: #required, queue: #queue, when_full: #when_full,
        }
    }
}

pub(super) fn expand_kind(private: &TokenStream, kind: GateKind) -> TokenStream {
    let kind = super::component::gate_struct(kind);
    quote!(#private::GateKind::#kind)
}

pub(super) fn expand_when_full(private: &TokenStream, when_full: WhenFull) -> TokenStream {
    let name = match when_full {
        WhenFull::DropOldest => "DropOldest",
        WhenFull::DropNewest => "DropNewest",
        WhenFull::Wait => "Wait",
    };
    let name = format_ident!("{name}");
    quote!(#private::WhenFull::#name)
}

fn expand_duration(private: &TokenStream, duration: Duration) -> TokenStream {
    let (seconds, nanoseconds) = (duration.as_secs(), duration.subsec_nanos());
    quote!(#private::Duration::new(#seconds, #nanoseconds))
}

/// `rover.Command -> rover.Status`, or `bytes`.
pub(super) fn payload_text(payload: &Payload) -> String {
    match payload {
        Payload::Bytes => "bytes".to_owned(),
        Payload::Message(name) => name.dotted().to_owned(),
        Payload::Exchange { request, reply } => format!("{} -> {}", request.dotted(), reply.dotted()),
    }
}

/// The codec as in the file.
pub(super) fn codec_text(codec: &Codec) -> &str {
    match codec {
        Codec::Protobuf => "protobuf",
        Codec::Json => "json",
        Codec::Cbor => "cbor",
        Codec::Msgpack => "msgpack",
        Codec::Postcard => "postcard",
        Codec::Raw => "raw",
        Codec::Path(path) => path,
    }
}
