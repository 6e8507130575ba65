//! A file with errors still becomes the structs that can be read from it, so that an editor keeps completing.
//!
//! Nothing here reports anything: the errors are told already. A type that the file does not tell stands as a type that
//! is wrong in rustc's eyes, about which rustc keeps silent.

use super::call::Call;
use super::component::gate_struct;
use super::names::identifier;
use super::problems::unknown_type_name;
use proc_macro2::{Span, TokenStream};
use quote::{quote, quote_spanned};
use scl_topology::model::{ComponentModel, GateModel};
use scl_topology::rust_name::{component_type, gate_field};
use scl_topology::topology::GateKind;
use std::collections::HashSet;

/// A struct for every component with a usable name, each once.
pub(super) fn expand_skeleton(call: &Call<'_>) -> TokenStream {
    let mut seen = HashSet::new();
    let components = &call.loaded.model.components;
    let wanted = components.iter().filter(|component| call.wants(&component.name.value));
    let first = wanted.filter(|component| seen.insert(component_type(&component.name.value)));
    let components = first.filter_map(|component| expand_component(call, component));
    quote! { #(#components)* }
}

fn expand_component(call: &Call<'_>, component: &ComponentModel) -> Option<TokenStream> {
    let private = &call.private;
    let name = identifier(&component_type(&component.name.value), Span::call_site())?;
    let mut seen = HashSet::new();
    // Two components of one name are most likely meant to be one.
    let same = call.loaded.model.components.iter().filter(|other| other.name.value == component.name.value);
    let gates = same.flat_map(|component| &component.gates).filter(|gate| seen.insert(gate_field(&gate.name.value)));
    let fields: Vec<TokenStream> = gates.filter_map(|gate| expand_gate(call, component, gate)).collect();
    let fields = if fields.is_empty() { quote!(_component: #private::Idle) } else { quote!(#(#fields),*) };
    let (text, place) = (&component.name.value, call.place(component.name.span));
    Some(quote_spanned! { call.span =>
        #[allow(dead_code, missing_docs, non_camel_case_types, non_snake_case)]
        pub struct #name { #fields }
        #[allow(dead_code)]
        const _: () = {
            impl #private::Component for #name {
                const SPEC: &'static #private::ComponentSpec =
                    &#private::ComponentSpec { system: "", name: #text, place: #place, gates: &[] };
                fn assemble(_: &mut #private::Opener) -> ::core::result::Result<Self, #private::OpenError> {
                    // Never compiled to a program: the file's errors stop the compiler.
                    ::core::unreachable!()
                }
                fn gates(&self) -> ::std::vec::Vec<&dyn #private::AnyGate> {
                    ::std::vec::Vec::new()
                }
            }
            #private::component_methods!(#name);
        };
    })
}

fn expand_gate(call: &Call<'_>, component: &ComponentModel, gate: &GateModel) -> Option<TokenStream> {
    let field = identifier(&gate_field(&gate.name.value), Span::call_site())?;
    let gate_type = expand_gate_type(call, component, gate);
    Some(quote!(pub #field: #gate_type))
}

/// The gate's type as far as it is known.
fn expand_gate_type(call: &Call<'_>, component: &ComponentModel, gate: &GateModel) -> TokenStream {
    let private = &call.private;
    let unknown = unknown_type_name(call);
    let Some(kind) = GateKind::ALL.into_iter().find(|kind| kind.word() == gate.kind.value) else {
        return quote!(#unknown);
    };
    let gate_type = gate_struct(kind);
    let mut messages = payload(call, component, gate).into_iter().flat_map(|text| text.split("->")).map(str::trim);
    let mut next = || {
        let path = messages.next().and_then(|dotted| call.types.path(dotted, call.span));
        path.unwrap_or_else(|| quote!(#unknown))
    };
    match kind {
        GateKind::Req | GateKind::Rep => {
            let (request, reply) = (next(), next());
            quote!(#private::#gate_type<#request, #reply>)
        }
        _ => {
            let message = next();
            quote!(#private::#gate_type<#message>)
        }
    }
}

/// The gate's own type text, or that of a gate that is connected to it.
fn payload<'a>(call: &'a Call<'_>, component: &ComponentModel, gate: &'a GateModel) -> Option<&'a str> {
    if let Some(own) = &gate.payload {
        return Some(&own.value);
    }
    let model = &call.loaded.model;
    let path = format!("{}.{}", component.name.value, gate.name.value);
    let peers = model.connections.iter().filter_map(|connection| match &connection.ends {
        [a, b] if a.value == path => Some(&b.value),
        [a, b] if b.value == path => Some(&a.value),
        _ => None,
    });
    peers.filter_map(|peer| peer.split_once('.')).find_map(|(owner, name)| {
        let owner = model.components.iter().find(|component| component.name.value == owner)?;
        let gate = owner.gates.iter().find(|gate| gate.name.value == name)?;
        gate.payload.as_ref().map(|payload| payload.value.as_str())
    })
}
