//! The structs that can be read from a file with errors, so that an editor keeps completing.
//!
//! The errors themselves are reported elsewhere. A type that cannot be read from the file becomes a type that rustc knows
//! to be erroneous, so using it causes no further errors.

use super::context::Context;
use super::kinds::gate_struct;
use super::names::identifier;
use super::problems::unknown_type_name;
use proc_macro2::{Span, TokenStream};
use quote::{quote, quote_spanned};
use scl_topology::model::{ComponentModel, GateModel};
use scl_topology::rust_name::{component_type, gate_field};
use scl_topology::topology::GateKind;
use std::collections::HashSet;
use syn::Ident;

/// The field that every struct has beside its gates.
const HANDLE_FIELD: &str = "__scl";

/// One struct for each component whose name can be a Rust type.
pub(super) fn expand_skeleton(context: &Context<'_>) -> TokenStream {
    let mut seen = HashSet::new();
    let components = context.loaded.model.components.iter();
    let included = components.filter(|component| context.includes(&component.name.value));
    let distinct = included.filter(|component| seen.insert(component_type(&component.name.value)));
    let structs = distinct.filter_map(|component| expand_component(context, component));
    quote! { #(#structs)* }
}

fn expand_component(context: &Context<'_>, component: &ComponentModel) -> Option<TokenStream> {
    let private = &context.private;
    let name = identifier(&component_type(&component.name.value), Span::call_site())?;
    let mut seen = HashSet::from([HANDLE_FIELD.to_owned()]);
    // Two components with the same name are probably meant to be one.
    let same_name = context.loaded.model.components.iter().filter(|other| other.name.value == component.name.value);
    let gates = same_name.flat_map(|component| &component.gates);
    let gates = gates.filter(|gate| seen.insert(gate_field(&gate.name.value)));
    let fields = gates.filter_map(|gate| expand_gate(context, component, gate));
    let handle = Ident::new(HANDLE_FIELD, context.span);
    let (text, declared_at) = (&component.name.value, context.location(component.name.span));
    Some(quote_spanned! { context.span =>
        #[allow(dead_code, missing_docs, non_camel_case_types, non_snake_case)]
        pub struct #name { #(#fields,)* #handle: #private::ComponentHandle }
        #[allow(dead_code)]
        const _: () = {
            impl #private::Component for #name {
                const SPEC: &'static #private::ComponentSpec = &#private::ComponentSpec {
                    system: "", name: #text, declared_at: #declared_at, gates: &[],
                    schema: ::core::option::Option::None,
                };
                fn assemble(_: &mut #private::Opener) -> ::core::result::Result<Self, #private::OpenError> {
                    // Never runs: the errors of the file stop the compiler.
                    ::core::unreachable!()
                }
                fn gates(&self) -> ::std::vec::Vec<&dyn #private::AnyGate> {
                    ::std::vec::Vec::new()
                }
                fn handle(&self) -> &#private::ComponentHandle {
                    &self.#handle
                }
            }
            #private::component_methods!(#name);
        };
    })
}

fn expand_gate(context: &Context<'_>, component: &ComponentModel, gate: &GateModel) -> Option<TokenStream> {
    let field = identifier(&gate_field(&gate.name.value), Span::call_site())?;
    let gate_type = expand_gate_type(context, component, gate);
    Some(quote!(pub #field: #gate_type))
}

/// The gate's type, with the unknown type for each part that cannot be read.
fn expand_gate_type(context: &Context<'_>, component: &ComponentModel, gate: &GateModel) -> TokenStream {
    let private = &context.private;
    let unknown = unknown_type_name(context);
    let Some(kind) = GateKind::ALL.into_iter().find(|kind| kind.word() == gate.kind.value) else {
        return quote!(#unknown);
    };
    let gate_type = gate_struct(kind);
    let mut messages = payload(context, component, gate).into_iter().flat_map(|text| text.split("->")).map(str::trim);
    let mut next = || {
        let path = messages.next().and_then(|dotted| context.types.path(dotted, context.span));
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

/// The type in the file: the gate's own, or that of the first connected gate that has one.
fn payload<'a>(context: &'a Context<'_>, component: &ComponentModel, gate: &'a GateModel) -> Option<&'a str> {
    if let Some(own) = &gate.payload {
        return Some(&own.value);
    }
    let model = &context.loaded.model;
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
