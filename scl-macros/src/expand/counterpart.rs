//! The counterpart of a component: a struct with the opposite gates, for unit tests.
//!
//! `Controller::test()` opens a `Controller` and a `ControllerPeer` that are connected within the process. All of it is
//! `#[cfg(test)]` in the crate that invokes the macro, so other builds do not compile it, unless it is `testable`.

use super::assemble::{Side, expand_methods};
use super::codec_traits::CodecTraits;
use super::context::Context;
use super::docs;
use super::gate_types::gate_type;
use super::names::{counterpart_name, field_name};
use super::schemas::EmbeddedSchemas;
use super::spec::expand_spec;
use super::structs::{self, GateField};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use scl_plan::Plan;
use scl_topology::topology::{Component, Topology};

/// The struct. It is expanded apart from the implementation, outside of the `const` block, so that users can name it.
pub(super) fn expand_struct(context: &Context<'_>, topology: &Topology, component: &Component) -> TokenStream {
    let for_tests = &context.for_tests;
    let fields = component.gates().iter().map(|&id| {
        let gate = topology.gate(id);
        let gate_type = gate_type(context, gate, Side::Counterpart.kind(gate.kind()));
        GateField { name: field_name(gate), doc: docs::of_other_end(&topology.gate_path(id)), gate_type }
    });
    let (name, doc) = (counterpart_name(component), docs::of_counterpart(component.name()));
    let peer = structs::expand_struct(context, &name, &doc, &fields.collect::<Vec<_>>());
    quote!(#for_tests #peer)
}

/// The implementation of `scl::Component`.
pub(super) fn expand_implementation(
    context: &Context<'_>,
    topology: &Topology,
    component: &Component,
    plan: &Plan,
    codec_traits: &CodecTraits<'_>,
) -> TokenStream {
    let (private, for_tests) = (&context.private, &context.for_tests);
    let name = counterpart_name(component);
    let methods = expand_methods(context, topology, component, codec_traits, Side::Counterpart);
    let spec = expand_spec(context, &plan.counterpart(), &EmbeddedSchemas::default());
    quote_spanned! { context.span =>
        #for_tests
        impl #private::Component for #name {
            const SPEC: &'static #private::ComponentSpec = &#spec;
            #methods
        }
    }
}
