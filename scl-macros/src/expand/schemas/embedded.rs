//! The descriptors of the messages that components use. Their programs embed them and compare them with those of their
//! peers.

use super::super::context::Context;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use scl_plan::{Plan, Schema};
use std::collections::HashMap;
use syn::Ident;

/// The embedded schemas of one invocation. Components with the same schema files share one constant, because it may be
/// large.
#[derive(Default)]
pub(in crate::expand) struct EmbeddedSchemas<'p> {
    all: Vec<&'p Schema>,
    by_hash: HashMap<&'p str, usize>,
}

impl<'p> EmbeddedSchemas<'p> {
    /// The schemas of the generated components.
    pub(in crate::expand) fn collect(plans: impl Iterator<Item = &'p Plan>) -> Self {
        let mut schemas = Self::default();
        for schema in plans.filter_map(|plan| plan.schema.as_ref()) {
            let next = schemas.all.len();
            if *schemas.by_hash.entry(&schema.hash).or_insert(next) == next {
                schemas.all.push(schema);
            }
        }
        schemas
    }

    /// The constants.
    pub(in crate::expand) fn expand(&self, context: &Context<'_>) -> TokenStream {
        let private = &context.private;
        let constants = self.all.iter().enumerate().map(|(index, schema)| {
            let (name, hash) = (constant_name(index), &schema.hash);
            let bytes = Literal::byte_string(&schema.descriptors);
            quote! {
                const #name: #private::Schema = #private::Schema { hash: #hash, descriptors: #bytes };
            }
        });
        quote!(#(#constants)*)
    }

    /// The `Option<Schema>` of a component: `None` without `schemas:`, and if its gates carry none of their messages.
    pub(in crate::expand) fn expand_reference(&self, schema: Option<&Schema>) -> TokenStream {
        match schema.and_then(|schema| self.by_hash.get(schema.hash.as_str())) {
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
