//! The constants that the runtime needs: `ComponentSpec`, `GateSpec`, `LinkSpec`.

use super::context::Context;
use super::kinds;
use super::schemas::EmbeddedSchemas;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use scl_topology::resolve;
use scl_topology::topology::{Component, ConnectionId, GateId, GateKind, Topology, WhenFull};
use std::time::Duration;

/// The `ComponentSpec` of a component.
pub(super) fn expand_spec(
    context: &Context<'_>,
    topology: &Topology,
    component: &Component,
    schemas: &EmbeddedSchemas,
) -> TokenStream {
    let private = &context.private;
    let (system, name) = (topology.system(), component.name());
    let declared_at = context.location(component.span());
    let gates = component.gates().iter().map(|&id| expand_gate(context, topology, id));
    let schema = schemas.of(component);
    quote! {
        #private::ComponentSpec {
            system: #system, name: #name, declared_at: #declared_at, gates: &[#(#gates),*], schema: #schema,
        }
    }
}

/// The variant of `GateKind`.
pub(super) fn expand_kind(private: &TokenStream, kind: GateKind) -> TokenStream {
    let variant = kinds::gate_struct(kind);
    quote!(#private::GateKind::#variant)
}

/// The variant of `WhenFull`.
pub(super) fn expand_when_full(private: &TokenStream, when_full: WhenFull) -> TokenStream {
    let variant = match when_full {
        WhenFull::DropOldest => format_ident!("DropOldest"),
        WhenFull::DropNewest => format_ident!("DropNewest"),
        WhenFull::Wait => format_ident!("Wait"),
    };
    quote!(#private::WhenFull::#variant)
}

fn expand_gate(context: &Context<'_>, topology: &Topology, id: GateId) -> TokenStream {
    let private = &context.private;
    let gate = topology.gate(id);
    let options = gate.options();
    let name = gate.name();
    let kind = expand_kind(private, gate.kind());
    let (payload, codec) = (gate.payload().to_string(), gate.codec().word());
    let declared_at = context.location(gate.span());
    let endpoint = resolve::gate_endpoint(topology, id).unwrap_or_default();
    let tap = resolve::tap_endpoint(topology, id).unwrap_or_default();
    let contract = resolve::gate_contract(topology, id);
    let (max_size, queue, backpressure) = (options.max_size, options.queue, options.backpressure);
    let when_full = expand_when_full(private, options.when_full);
    let timeout = expand_duration(private, options.timeout);
    let links = gate.connections().iter().map(|&connection| expand_link(context, topology, id, connection));
    quote! {
        #private::GateSpec {
            name: #name, kind: #kind, payload: #payload, codec: #codec, declared_at: #declared_at,
            endpoint: #endpoint, tap: #tap, contract: #contract, max_size: #max_size,
            queue: #queue, when_full: #when_full, backpressure: #backpressure, timeout: #timeout,
            links: &[#(#links),*],
        }
    }
}

fn expand_link(context: &Context<'_>, topology: &Topology, gate: GateId, id: ConnectionId) -> TokenStream {
    let private = &context.private;
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
    let max_size = max_size(topology, gate, id);
    quote! {
        #private::LinkSpec {
            peer_component: #peer_component, peer_gate: #peer_gate, endpoint: #endpoint, contract: #contract,
            required: #required, queue: #queue, when_full: #when_full, max_size: #max_size,
        }
    }
}

/// The longest message that the peer accepts from a gate. `sub` and `pull` send nothing, so theirs is their own limit.
fn max_size(topology: &Topology, gate: GateId, id: ConnectionId) -> u64 {
    let receiver = match topology.gate(gate).kind() {
        GateKind::Sub | GateKind::Pull => gate,
        GateKind::Pub | GateKind::Push | GateKind::Req | GateKind::Rep => topology.connection(id).peer_of(gate),
    };
    topology.gate(receiver).options().max_size
}

fn expand_duration(private: &TokenStream, duration: Duration) -> TokenStream {
    let (seconds, nanoseconds) = (duration.as_secs(), duration.subsec_nanos());
    quote!(#private::Duration::new(#seconds, #nanoseconds))
}
