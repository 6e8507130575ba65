//! Serde's traits for the messages of the schemas: canonical protobuf JSON, if the crate `scl` has it.

use super::super::context::Context;
use proc_macro2::{Literal, TokenStream};
use quote::{quote, quote_spanned};
use std::collections::BTreeSet;

/// The implementations for all messages. A broken topology gets none: they would only be more to compile.
pub(super) fn expand_json(context: &Context<'_>) -> TokenStream {
    let (Some(schemas), Some(_)) = (&context.loaded.schemas, &context.loaded.topology) else {
        return TokenStream::new();
    };
    let messages = context.types.of_schemas(context.span);
    let names: BTreeSet<&str> = messages.iter().map(|(name, _)| *name).collect();
    let Some(schema) = schemas.descriptors_of(&names) else { return TokenStream::new() };
    let private = &context.private;
    let bytes = Literal::byte_string(&schema.descriptors);
    let messages = messages.iter().map(|(name, path)| quote!(#path = #name));
    quote_spanned! { context.span =>
        const _: () = { #private::message_json! { #bytes #(#messages)* } };
    }
}
