//! The descriptors of the messages that a component uses. Its program embeds them and compares them with those of its
//! peers.

use super::super::context::Context;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use scl_loader::Descriptors;
use scl_topology::topology::{Component, Payload, Topology, TypeName};
use std::collections::{BTreeSet, HashMap};
use syn::Ident;

/// The embedded schemas of one invocation. Components with the same schema files share one constant, because its bytes
/// may be many.
#[derive(Default)]
pub(in crate::expand) struct EmbeddedSchemas {
    all: Vec<Descriptors>,
    /// Component names to indices in `all`; a component without typed gates is not in it.
    by_component: HashMap<String, usize>,
}

impl EmbeddedSchemas {
    /// The schemas of the generated components.
    pub(in crate::expand) fn collect(context: &Context<'_>, topology: &Topology) -> Self {
        let mut schemas = Self::default();
        let Some(compiled) = &context.loaded.schemas else { return schemas };
        let mut by_hash = HashMap::new();
        let components = topology.components().map(|(_, component)| component);
        for component in components.filter(|component| context.includes(component.name())) {
            let Some(descriptors) = compiled.descriptors_of(&messages(topology, component)) else { continue };
            let next = schemas.all.len();
            let index = *by_hash.entry(descriptors.hash.clone()).or_insert(next);
            if index == next {
                schemas.all.push(descriptors);
            }
            schemas.by_component.insert(component.name().to_owned(), index);
        }
        schemas
    }

    /// The constants.
    pub(in crate::expand) fn expand(&self, context: &Context<'_>) -> TokenStream {
        let private = &context.private;
        let constants = self.all.iter().enumerate().map(|(index, descriptors)| {
            let (name, hash) = (constant_name(index), &descriptors.hash);
            let bytes = Literal::byte_string(&descriptors.bytes);
            quote! {
                const #name: #private::Schema = #private::Schema { hash: #hash, descriptors: #bytes };
            }
        });
        quote!(#(#constants)*)
    }

    /// The `Option<Schema>` of a component: `None` without `schemas:`, and if its gates carry only bytes.
    pub(in crate::expand) fn of(&self, component: &Component) -> TokenStream {
        match self.by_component.get(component.name()) {
            Some(&index) => {
                let name = constant_name(index);
                quote!(::core::option::Option::Some(#name))
            }
            None => quote!(::core::option::Option::None),
        }
    }
}

fn constant_name(index: usize) -> Ident {
    format_ident!("SCHEMA_{index}")
}

/// The message types of the component's gates, whatever their codec.
fn messages<'a>(topology: &'a Topology, component: &Component) -> BTreeSet<&'a str> {
    let payloads = component.gates().iter().map(|&id| topology.gate(id).payload());
    let types = payloads.flat_map(|payload| match payload {
        Payload::Bytes => Vec::new(),
        Payload::Message(name) => vec![name],
        Payload::Exchange { request, reply } => vec![request, reply],
    });
    types.map(TypeName::dotted).collect()
}
