//! The other ends of all gates of a component, for its unit tests.
//!
//! `Controller::test()` opens a `Controller` and a `ControllerPeer` that are connected within the process. All of it is
//! `#[cfg(test)]` of the crate that calls the macro, so that nobody else compiles it.

use super::assertions::Carriers;
use super::call::Call;
use super::component::{expand_opened, field_name, gate_type, struct_name};
use super::spec::{codec_text, expand_kind, payload_text};
use proc_macro2::TokenStream;
use quote::{format_ident, quote, quote_spanned};
use scl_topology::resolve;
use scl_topology::topology::{Component, GateId, GateKind, Topology};

/// The struct with the opposite gates, and the functions that open it beside the component.
pub(super) fn expand_counterpart(
    call: &Call<'_>,
    topology: &Topology,
    component: &Component,
    carriers: &Carriers<'_>,
) -> TokenStream {
    if component.gates().is_empty() {
        return TokenStream::new();
    }
    let private = &call.private;
    let name = struct_name(component);
    let peer = format_ident!("{name}Peer");
    let opened = expand_opened(call, topology, component, carriers, |kind| kind.opposite());
    let fields = component.gates().iter().map(|&id| field_name(topology, id));
    let gates = fields.map(|field| quote_spanned!(call.span => &self.#field as &dyn #private::AnyGate));
    let specs = component.gates().iter().map(|&id| expand_gate(call, topology, component, id));
    let (system, peer_name) = (topology.system(), format!("{}'s peers", component.name()));
    quote_spanned! { call.span =>
        #[cfg(test)]
        impl #private::Component for #peer {
            const SPEC: &'static #private::ComponentSpec =
                &#private::ComponentSpec { system: #system, name: #peer_name, place: "", gates: &[#(#specs),*] };
            fn assemble(__opener: &mut #private::Opener) -> ::core::result::Result<Self, #private::OpenError> {
                ::core::result::Result::Ok(Self { #opened })
            }
            fn gates(&self) -> ::std::vec::Vec<&dyn #private::AnyGate> {
                ::std::vec::Vec::from([#(#gates),*])
            }
        }
        #[cfg(test)]
        #private::component_test_methods!(#name, #peer);
    }
}

/// The struct itself, which has to stand where users can name it.
pub(super) fn expand_struct(call: &Call<'_>, topology: &Topology, component: &Component) -> TokenStream {
    if component.gates().is_empty() {
        return TokenStream::new();
    }
    let name = format_ident!("{}Peer", struct_name(component));
    let doc = format!("The other ends of all gates of `{}`, for its unit tests.", component.name());
    let fields = component.gates().iter().map(|&id| {
        let field = field_name(topology, id);
        let gate = gate_type(call, topology, id, topology.gate(id).kind().opposite());
        let doc = format!("The other end of `{}`.", topology.gate_path(id));
        quote! { #[doc = #doc] pub #field: #gate }
    });
    quote! {
        #[cfg(test)]
        #[doc = #doc]
        #[allow(dead_code, non_camel_case_types, non_snake_case)]
        pub struct #name { #(#fields),* }
    }
}

/// One end opposite to a gate: it stands for all its peers, over the first of their connections.
fn expand_gate(call: &Call<'_>, topology: &Topology, component: &Component, id: GateId) -> TokenStream {
    let private = &call.private;
    let gate = topology.gate(id);
    let kind = gate.kind().opposite();
    let (name, owner) = (gate.name(), component.name());
    let (payload, codec, place) = (payload_text(gate.payload()), codec_text(gate.codec()), call.place(gate.span()));
    let first = gate.connections().first().map(|&connection| resolve::endpoint(topology, connection));
    let meeting = first.or_else(|| resolve::gate_endpoint(topology, id)).unwrap_or_default();
    let listens_for_all = matches!(kind, GateKind::Rep | GateKind::Pull);
    let endpoint = if listens_for_all { meeting.clone() } else { format!("{owner}.{name}.peer") };
    let queue = gate.options().queue;
    let when_full = super::spec::expand_when_full(private, gate.options().when_full);
    let kind = expand_kind(private, kind);
    // The counterpart loses nothing by itself: what a test sees lost was lost by the gate under test.
    quote! {
        #private::GateSpec {
            name: #name, kind: #kind, payload: #payload, codec: #codec, place: #place, endpoint: #endpoint,
            queue: ::core::primitive::u32::MAX, when_full: #private::WhenFull::Wait, backpressure: true,
            timeout: #private::Duration::from_secs(10),
            links: &[#private::LinkSpec {
                peer_component: #owner, peer_gate: #name, endpoint: #meeting, contract: "", required: true,
                queue: #queue, when_full: #when_full,
            }],
        }
    }
}
