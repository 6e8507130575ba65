//! What a kind of components adds to its struct: the enum of its components, and their plans.

use super::context::Context;
use super::docs;
use super::names::{instance_name, variant_name};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use scl_topology::topology::{ComponentType, Kind, Topology};
use syn::Ident;

/// The enum of the components; nothing for a component of no kind.
pub(super) fn expand_enum(context: &Context<'_>, topology: &Topology, of: ComponentType<'_>) -> TokenStream {
    let Some(kind) = of.kind else { return TokenStream::new() };
    let components = kind.components().iter().map(|id| topology.component(*id)).map(|component| Instance {
        variant: variant_name(component),
        name: component.name(),
        doc: docs::of_instance(context, component.name(), component.doc(), component.span()),
    });
    expand_instances(context, &instance_name(kind.name()), kind.name(), components)
}

/// A component of a kind.
pub(super) struct Instance<'t> {
    pub(super) variant: Ident,
    pub(super) name: &'t str,
    pub(super) doc: String,
}

/// The enum of components of a kind.
pub(super) fn expand_instances<'t>(
    context: &Context<'_>,
    name: &Ident,
    kind: &str,
    instances: impl Iterator<Item = Instance<'t>>,
) -> TokenStream {
    let private = &context.private;
    let doc = format!("The components of the kind `{kind}`.");
    let variants = instances.map(|Instance { variant, name, doc }| quote!(#[doc = #doc] #variant = #name,));
    quote_spanned! { context.span =>
        #private::instances! {
            #[doc = #doc]
            #name { #(#variants)* }
        }
    }
}

/// The constant `KIND` of the struct. The plans are texts, because a thousand of them must cost the compiler no more
/// than one.
pub(super) fn expand_constant(context: &Context<'_>, topology: &Topology, kind: &Kind) -> TokenStream {
    let private = &context.private;
    let location = |span| context.location(span);
    let components = kind.components().iter().map(|id| {
        let mut plan = context.loaded.plan(topology, *id, &location);
        // The program has the messages once, in the constant of the first component.
        plan.schema = None;
        let (name, plan) = (topology.component(*id).name(), plan.to_json());
        quote!((#name, #plan))
    });
    let name = kind.name();
    quote_spanned! { context.span =>
        const KIND: ::core::option::Option<&'static #private::KindSpec> =
            ::core::option::Option::Some(&#private::KindSpec { name: #name, components: &[#(#components),*] });
    }
}
