//! The struct of a component, and its implementation of `scl::Component`.

use super::assemble::{Side, expand_methods};
use super::codec_traits::CodecTraits;
use super::context::Context;
use super::gate_types::gate_type;
use super::names::{counterpart_name, field_name, struct_name};
use super::schemas::EmbeddedSchemas;
use super::{counterpart, docs, spec, type_agreement};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use scl_plan::Plan;
use scl_topology::topology::{Component, Topology};

/// All generated components, with the checks that only rustc can make.
pub(super) fn expand_components(context: &Context<'_>, topology: &Topology) -> TokenStream {
    let included = topology.components().filter(|(_, component)| context.includes(component.name()));
    let location = |span| context.location(span);
    let components: Vec<(&Component, Plan)> =
        included.map(|(id, component)| (component, context.loaded.plan(topology, id, &location))).collect();
    let codec_traits = CodecTraits::collect(context, topology);
    let structs = components.iter().map(|(component, _)| expand_struct(context, topology, component));
    let traits = codec_traits.expand(context, topology);
    let schemas = EmbeddedSchemas::collect(components.iter().map(|(_, plan)| plan));
    let constants = schemas.expand(context);
    let implementations = components
        .iter()
        .map(|(component, plan)| expand_implementation(context, topology, component, plan, &codec_traits, &schemas));
    let agreements = type_agreement::expand_agreements(context, topology);
    // With the span of the literal, rustc's own errors about a type point there and not into a macro.
    quote_spanned! { context.span =>
        #(#structs)*
        #[allow(dead_code, non_camel_case_types, non_snake_case, clippy::all, clippy::pedantic)]
        const _: () = {
            #traits
            #constants
            #(#implementations)*
        };
        #agreements
    }
}

/// The structs of the component and of its counterpart. They stand outside of the `const` block so that users can name
/// them.
fn expand_struct(context: &Context<'_>, topology: &Topology, component: &Component) -> TokenStream {
    let name = struct_name(component);
    let doc = docs::of_component(context, topology, component);
    let fields = component.gates().iter().map(|&id| {
        let gate = topology.gate(id);
        let field = field_name(gate);
        let doc = docs::of_gate(context, topology, id);
        let gate_type = gate_type(context, gate, gate.kind());
        quote! { #[doc = #doc] pub #field: #gate_type, }
    });
    let counterpart = counterpart::expand_struct(context, topology, component);
    let private = &context.private;
    // `__scl` is the last field: fields are dropped in order, and the gates go first.
    quote! {
        #[doc = #doc]
        #[allow(dead_code, non_camel_case_types, non_snake_case)]
        pub struct #name { #(#fields)* __scl: #private::ComponentHandle }
        #counterpart
    }
}

fn expand_implementation(
    context: &Context<'_>,
    topology: &Topology,
    component: &Component,
    plan: &Plan,
    codec_traits: &CodecTraits<'_>,
    schemas: &EmbeddedSchemas<'_>,
) -> TokenStream {
    let private = &context.private;
    let (name, peer) = (struct_name(component), counterpart_name(component));
    let spec = spec::expand_spec(context, plan, schemas);
    let methods = expand_methods(context, topology, component, codec_traits, Side::Component);
    let counterpart = counterpart::expand_implementation(context, topology, component, plan, codec_traits);
    quote_spanned! { context.span =>
        impl #private::Component for #name {
            const SPEC: &'static #private::ComponentSpec = &#spec;
            #methods
        }
        #private::component_methods!(#name);
        #counterpart
        #[cfg(test)]
        #private::component_test_methods!(#name, #peer);
    }
}
