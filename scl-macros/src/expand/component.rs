//! A checked component becomes a struct with its gates, and the code that opens them.

use super::assertions::{self, Carrier, Carriers};
use super::call::Call;
use super::{counterpart, docs, names, spec};
use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use scl_topology::topology::{Component, GateId, GateKind, Payload, Topology};
use syn::Ident;

/// Every wanted component, and the checks among them that only rustc can make.
pub(super) fn expand_components(call: &Call<'_>, topology: &Topology) -> TokenStream {
    let wanted = topology.components().map(|(_, component)| component).filter(|component| call.wants(component.name()));
    let wanted: Vec<&Component> = wanted.collect();
    let carriers = assertions::carriers(call, topology);
    let structs = wanted.iter().map(|component| expand_struct(call, topology, component));
    let traits = carriers.iter().map(|carrier| carrier.expand(call, topology));
    let implementations = wanted.iter().map(|component| expand_implementation(call, topology, component, &carriers));
    let agreements = assertions::expand_agreements(call, topology);
    // The place of the literal, so that rustc's own words about a type point there and not into a macro.
    quote_spanned! { call.span =>
        #(#structs)*
        #[allow(dead_code, non_camel_case_types, non_snake_case, clippy::all, clippy::pedantic)]
        const _: () = {
            #(#traits)*
            #(#implementations)*
        };
        #agreements
    }
}

fn expand_struct(call: &Call<'_>, topology: &Topology, component: &Component) -> TokenStream {
    let private = &call.private;
    let name = struct_name(component);
    let doc = docs::of_component(call, topology, component);
    let fields = component.gates().iter().map(|&id| {
        let field = field_name(topology, id);
        let doc = docs::of_gate(call, topology, id);
        let gate = gate_type(call, topology, id, topology.gate(id).kind());
        quote! { #[doc = #doc] pub #field: #gate }
    });
    let fields = match component.gates() {
        [] => quote! { _component: #private::Idle },
        _ => quote! { #(#fields),* },
    };
    let counterpart = counterpart::expand_struct(call, topology, component);
    quote! {
        #[doc = #doc]
        #[allow(dead_code, non_camel_case_types, non_snake_case)]
        pub struct #name { #fields }
        #counterpart
    }
}

fn expand_implementation(
    call: &Call<'_>,
    topology: &Topology,
    component: &Component,
    carriers: &Carriers<'_>,
) -> TokenStream {
    let private = &call.private;
    let name = struct_name(component);
    let spec = spec::expand_spec(call, topology, component);
    let opened = expand_opened(call, topology, component, carriers, GateKind::clone);
    let fields = component.gates().iter().map(|&id| field_name(topology, id));
    let gates = fields.map(|field| quote_spanned!(call.span => &self.#field as &dyn #private::AnyGate));
    let counterpart = counterpart::expand_counterpart(call, topology, component, carriers);
    quote_spanned! { call.span =>
        impl #private::Component for #name {
            const SPEC: &'static #private::ComponentSpec = &#spec;
            fn assemble(__opener: &mut #private::Opener) -> ::core::result::Result<Self, #private::OpenError> {
                ::core::result::Result::Ok(Self { #opened })
            }
            fn gates(&self) -> ::std::vec::Vec<&dyn #private::AnyGate> {
                ::std::vec::Vec::from([#(#gates),*])
            }
        }
        #private::component_methods!(#name);
        #counterpart
    }
}

/// The fields of `Self { .. }`, each opened by its position in the specification.
///
/// `side` says which end of its connections is opened: a gate's own kind, or the one at the other end.
pub(super) fn expand_opened(
    call: &Call<'_>,
    topology: &Topology,
    component: &Component,
    carriers: &Carriers<'_>,
    side: fn(&GateKind) -> GateKind,
) -> TokenStream {
    let private = &call.private;
    if component.gates().is_empty() {
        return quote_spanned! { call.span => _component: __opener.idle()? };
    }
    let fields = component.gates().iter().enumerate().map(|(index, &id)| {
        let gate = topology.gate(id);
        let field = field_name(topology, id);
        let kind = side(&gate.kind());
        let method = opener_method(call, kind);
        match carriers.of(gate) {
            // The types are inferred from the struct, so that a wrong one is reported once, there.
            Some(Carrier { name, .. }) => quote_spanned! { call.span => #field: #name::#method(__opener, #index)? },
            None => {
                let bytes = bytes(call, kind);
                quote_spanned! { call.span => #field: __opener.#method::<#bytes, #private::codec::Opaque>(#index)? }
            }
        }
    });
    quote! { #(#fields),* }
}

/// The arguments of a gate without a type: bytes, in both directions where there are two.
fn bytes(call: &Call<'_>, kind: GateKind) -> TokenStream {
    let private = &call.private;
    match kind {
        GateKind::Req | GateKind::Rep => quote!(#private::Bytes, #private::Bytes),
        _ => quote!(#private::Bytes),
    }
}

/// `Sub<rover::Measurement>`, or for the other end `Pub<rover::Measurement>`.
pub(super) fn gate_type(call: &Call<'_>, topology: &Topology, id: GateId, kind: GateKind) -> TokenStream {
    let private = &call.private;
    let gate = topology.gate(id);
    let message = |dotted: &str| message_type(call, dotted);
    match gate.payload() {
        Payload::Bytes => {
            let bytes = bytes(call, kind);
            let kind = gate_struct(kind);
            quote!(#private::#kind<#bytes>)
        }
        Payload::Message(name) => {
            let (kind, message) = (gate_struct(kind), message(name.dotted()));
            quote!(#private::#kind<#message>)
        }
        Payload::Exchange { request, reply } => {
            let (kind, request, reply) = (gate_struct(kind), message(request.dotted()), message(reply.dotted()));
            quote!(#private::#kind<#request, #reply>)
        }
    }
}

pub(super) fn struct_name(component: &Component) -> Ident {
    names::checked(component.rust_name(), Span::call_site())
}

/// The path of a type that the checks have accepted.
pub(super) fn message_type(call: &Call<'_>, dotted: &str) -> TokenStream {
    let problem = format!("`{dotted}` is no type that Rust can name");
    let refused = || quote_spanned!(call.span => ::core::compile_error!(#problem));
    call.types.path(dotted, call.span).unwrap_or_else(refused)
}

pub(super) fn field_name(topology: &Topology, id: GateId) -> Ident {
    names::checked(topology.gate(id).rust_name(), Span::call_site())
}

/// The gate's type in the crate `scl`.
pub(super) fn gate_struct(kind: GateKind) -> Ident {
    let name = match kind {
        GateKind::Pub => "Pub",
        GateKind::Sub => "Sub",
        GateKind::Req => "Req",
        GateKind::Rep => "Rep",
        GateKind::Push => "Push",
        GateKind::Pull => "Pull",
    };
    format_ident!("{name}")
}

/// The method of the opener that opens it.
pub(super) fn opener_method(call: &Call<'_>, kind: GateKind) -> Ident {
    let name = match kind {
        GateKind::Pub => "publisher",
        GateKind::Sub => "subscriber",
        GateKind::Req => "requester",
        GateKind::Rep => "replier",
        GateKind::Push => "pusher",
        GateKind::Pull => "puller",
    };
    Ident::new(name, call.span)
}
