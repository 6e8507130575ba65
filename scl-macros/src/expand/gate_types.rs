//! The types of generated fields: `Sub<rover::Measurement>`.

use super::context::Context;
use super::kinds::gate_struct;
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use scl_topology::topology::{Gate, GateKind, Payload};
use syn::Ident;

/// The type of a gate for a kind, the gate's own or the opposite one for its counterpart, perhaps with an enum of its
/// senders.
pub(super) fn gate_type(context: &Context<'_>, gate: &Gate, kind: GateKind, senders: Option<Ident>) -> TokenStream {
    let (private, name) = (&context.private, gate_struct(kind));
    let (messages, senders) = (messages(context, gate, kind), senders.into_iter());
    quote!(#private::#name<#messages #(, #senders)*>)
}

fn messages(context: &Context<'_>, gate: &Gate, kind: GateKind) -> TokenStream {
    match gate.payload() {
        Payload::Bytes => bytes(context, kind),
        Payload::Message(message) => message_type(context, message.dotted()),
        Payload::Exchange { request, reply } => {
            let (request, reply) = (message_type(context, request.dotted()), message_type(context, reply.dotted()));
            quote!(#request, #reply)
        }
    }
}

/// The type arguments of a gate without a message type: bytes in each direction.
pub(super) fn bytes(context: &Context<'_>, kind: GateKind) -> TokenStream {
    let private = &context.private;
    if kind.exchanges() { quote!(#private::Bytes, #private::Bytes) } else { quote!(#private::Bytes) }
}

/// The path of a message type that the checks have accepted.
pub(super) fn message_type(context: &Context<'_>, dotted: &str) -> TokenStream {
    context.types.path(dotted, context.span).unwrap_or_else(|| {
        let problem = format!("`{dotted}` is not a path of a Rust type");
        quote_spanned!(context.span => ::core::compile_error!(#problem))
    })
}
