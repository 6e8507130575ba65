//! The enums of senders, for gates with several.

use super::context::Context;
use super::names::{checked, instance_name};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use scl_topology::senders::{Peer, Senders};
use scl_topology::topology::{ComponentType, Topology};
use syn::Ident;

/// The type of the enum.
pub(super) fn sender_type(senders: &Senders<'_>) -> Ident {
    match senders {
        Senders::OfKind(kind) => instance_name(kind),
        Senders::Own { name, .. } => checked(name),
    }
}

/// The enums of the gates of a component, other than those of kinds.
pub(super) fn expand_enums(context: &Context<'_>, topology: &Topology, of: ComponentType<'_>) -> TokenStream {
    let gates = of.component.gates().iter().filter_map(|&gate| Some((topology.gate(gate), topology.senders(gate)?)));
    gates
        .filter_map(|(gate, senders)| expand_enum(context, &format!("{}.{}", of.name(), gate.name()), &senders))
        .collect()
}

/// The enum of a gate; `None` if it is that of a kind.
pub(super) fn expand_enum(context: &Context<'_>, gate: &str, senders: &Senders<'_>) -> Option<TokenStream> {
    let Senders::Own { name, variants } = senders else { return None };
    let (private, name) = (&context.private, checked(name));
    let doc = format!("The gates that send to `{gate}`.");
    let variants = variants.iter().map(|(variant, Peer { component, gate, .. })| {
        let (variant, doc) = (checked(variant), format!("`{component}.{gate}`."));
        quote!(#[doc = #doc] #variant = (#component, #gate),)
    });
    Some(quote_spanned! { context.span =>
        #private::senders! {
            #[doc = #doc]
            #name { #(#variants)* }
        }
    })
}

/// The kinds whose components a gate of this component tells apart.
pub(super) fn kinds_told_apart<'t>(topology: &'t Topology, of: ComponentType<'_>) -> impl Iterator<Item = &'t str> {
    of.component.gates().iter().filter_map(|&gate| match topology.senders(gate)? {
        Senders::OfKind(kind) => Some(kind),
        Senders::Own { .. } => None,
    })
}
