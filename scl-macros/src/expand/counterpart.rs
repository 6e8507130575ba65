//! The counterpart of a component: a struct with the opposite gates, for unit tests.
//!
//! `Controller::test()` opens a `Controller` and a `ControllerPeer` that are connected within the process. All of it is
//! `#[cfg(test)]` in the crate that invokes the macro, so other builds do not compile it.

use super::assemble::{Side, expand_methods};
use super::codec_traits::CodecTraits;
use super::context::Context;
use super::gate_types::gate_type;
use super::names::{counterpart_name, field_name};
use super::spec::{expand_kind, expand_when_full};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use scl_topology::resolve;
use scl_topology::topology::{Component, GateId, GateKind, Topology};

/// The struct. It is expanded apart from the implementation, outside of the `const` block, so that users can name it.
pub(super) fn expand_struct(context: &Context<'_>, topology: &Topology, component: &Component) -> TokenStream {
    let private = &context.private;
    let name = counterpart_name(component);
    let doc = format!("The other ends of all gates of `{}`, for its unit tests.", component.name());
    let fields = component.gates().iter().map(|&id| {
        let gate = topology.gate(id);
        let field = field_name(gate);
        let gate_type = gate_type(context, gate, Side::Counterpart.kind(gate.kind()));
        let doc = format!("The other end of `{}`.", topology.gate_path(id));
        quote! { #[doc = #doc] pub #field: #gate_type, }
    });
    quote! {
        #[cfg(test)]
        #[doc = #doc]
        #[allow(dead_code, non_camel_case_types, non_snake_case, private_interfaces)]
        pub struct #name { #(#fields)* __scl: #private::ComponentHandle }
    }
}

/// The implementation of `scl::Component`.
pub(super) fn expand_implementation(
    context: &Context<'_>,
    topology: &Topology,
    component: &Component,
    codec_traits: &CodecTraits<'_>,
) -> TokenStream {
    let private = &context.private;
    let name = counterpart_name(component);
    let methods = expand_methods(context, topology, component, codec_traits, Side::Counterpart);
    let gates = component.gates().iter().map(|&id| expand_gate(context, topology, component, id));
    let (system, spec_name) = (topology.system(), format!("{}'s peers", component.name()));
    quote_spanned! { context.span =>
        #[cfg(test)]
        impl #private::Component for #name {
            const SPEC: &'static #private::ComponentSpec = &#private::ComponentSpec {
                system: #system, name: #spec_name, declared_at: "", gates: &[#(#gates),*],
                schema: ::core::option::Option::None,
            };
            #methods
        }
    }
}

/// The specification of a gate that takes the part of all peers of one gate. It uses the endpoint of the first
/// connection.
fn expand_gate(context: &Context<'_>, topology: &Topology, component: &Component, id: GateId) -> TokenStream {
    let private = &context.private;
    let gate = topology.gate(id);
    let kind = Side::Counterpart.kind(gate.kind());
    let (owner, name) = (component.name(), gate.name());
    let (payload, codec) = (gate.payload().to_string(), gate.codec().word());
    let declared_at = context.location(gate.span());
    let first = gate.connections().first();
    let endpoint = first.map(|&connection| resolve::endpoint(topology, connection));
    let link_endpoint = endpoint.or_else(|| resolve::gate_endpoint(topology, id)).unwrap_or_default();
    let contract = first.map_or_else(|| resolve::gate_contract(topology, id), |&id| resolve::contract(topology, id));
    let own_endpoint = if matches!(kind, GateKind::Rep | GateKind::Pull) { link_endpoint.as_str() } else { "" };
    let tap = if kind.listens() { format!("{owner}.{name}.peer") } else { String::new() };
    // The counterpart itself drops and refuses nothing: what a test misses was dropped by the gate under test.
    let unlimited = quote!(::core::primitive::u64::MAX);
    let limit = gate.options().max_size;
    let peer_limit = if matches!(kind, GateKind::Sub | GateKind::Pull) { unlimited.clone() } else { quote!(#limit) };
    let queue = gate.options().queue;
    let when_full = expand_when_full(private, gate.options().when_full);
    let kind = expand_kind(private, kind);
    quote! {
        #private::GateSpec {
            name: #name, kind: #kind, payload: #payload, codec: #codec, declared_at: #declared_at,
            endpoint: #own_endpoint, tap: #tap, contract: #contract, max_size: #unlimited,
            queue: ::core::primitive::u32::MAX, when_full: #private::WhenFull::Wait, backpressure: true,
            timeout: #private::Duration::from_secs(10),
            links: &[#private::LinkSpec {
                peer_component: #owner, peer_gate: #name, endpoint: #link_endpoint, contract: #contract,
                required: true, queue: #queue, when_full: #when_full, max_size: #peer_limit,
            }],
        }
    }
}
