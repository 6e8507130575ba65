//! The structs of a component and of its counterpart for unit tests, which has the opposite gates, and their
//! implementations of `scl::Component`.

use super::assemble::{Side, expand_methods};
use super::codec_traits::CodecTraits;
use super::context::Context;
use super::docs::{self, GateDoc};
use super::found_types::Requirements;
use super::gate_types::gate_type;
use super::kind;
use super::names::{counterpart_name, field_name, instance_name, struct_name};
use super::parameters;
use super::schemas::EmbeddedSchemas;
use super::senders::{self, kinds_told_apart, sender_type};
use super::spec::expand_spec;
use super::structs::{GateField, expand_struct};
use super::type_agreement;
use super::unopened::expand_unopened;
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use scl_plan::Plan;
use scl_topology::topology::{ComponentType, Topology};
use std::collections::HashSet;
use syn::Ident;

/// All generated components, with the checks that only rustc can make.
pub(super) fn expand_components(context: &Context<'_>, topology: &Topology) -> TokenStream {
    let included = || topology.types().filter(|it| context.includes(it.name()));
    let structs = included().map(|it| expand_structs(context, topology, it));
    let told_apart: HashSet<&str> = included().flat_map(|it| kinds_told_apart(topology, it)).collect();
    let kinds = topology.types().filter(|it| context.includes(it.name()) || told_apart.contains(it.name()));
    let kinds = kinds.map(|it| kind::expand_enum(context, topology, it));
    let senders = included().map(|it| senders::expand_enums(context, topology, it));
    let enums = quote!(#(#kinds)* #(#senders)*);
    if context.for_editor {
        let methods = included().map(|it| {
            let instance = it.kind.map(|kind| instance_name(kind.name()));
            expand_unopened(context, &struct_name(it), instance.as_ref(), Some(&counterpart_name(it)))
        });
        return quote!(#(#structs)* #enums #(#methods)*);
    }
    let location = |span| context.location(span);
    let components: Vec<(ComponentType<'_>, Plan)> =
        included().map(|it| (it, context.loaded.plan(topology, it.id, &location))).collect();
    let codec_traits = CodecTraits::collect(context, topology);
    let traits = codec_traits.expand(context, topology);
    let requirements = Requirements::collect(context, topology);
    let found_types = requirements.expand(context);
    let schemas = EmbeddedSchemas::collect(components.iter().map(|(_, plan)| plan));
    let constants = schemas.expand(context);
    let implementations = components.iter().map(|(component, plan)| {
        expand_implementation(context, topology, *component, plan, &codec_traits, &schemas, &requirements)
    });
    let agreements = type_agreement::expand_agreements(context, topology);
    // With the span of the literal, rustc's own errors about a type point at the literal and not into a macro.
    quote_spanned! { context.span =>
        #(#structs)*
        #enums
        #[allow(
            dead_code, non_camel_case_types, non_snake_case, private_bounds, private_interfaces, clippy::all,
            clippy::pedantic
        )]
        const _: () = {
            #traits
            #found_types
            #constants
            #(#implementations)*
        };
        #agreements
    }
}

/// The structs of the component and of its counterpart. They stand outside of the `const` block so that users can name
/// them.
fn expand_structs(context: &Context<'_>, topology: &Topology, component: ComponentType<'_>) -> TokenStream {
    let for_tests = &context.for_tests;
    let [own, counterpart] = [Side::Component, Side::Counterpart].map(|side| {
        let fields = component.component.gates().iter().map(|&id| {
            let gate = topology.gate(id);
            let doc = match side {
                Side::Component => GateDoc::new(context, topology, id).text(),
                Side::Counterpart => docs::of_other_end(&topology.gate_path(id)),
            };
            let gate_type = match side {
                Side::Component => {
                    let senders = topology.senders(id);
                    gate_type(context, gate, gate.kind(), senders.as_ref().map(sender_type))
                }
                Side::Counterpart => gate_type(context, gate, side.kind(gate.kind()), None),
            };
            GateField { name: field_name(gate), doc, gate_type }
        });
        let (name, doc, parameters) = match side {
            Side::Component => {
                let parameters = parameters::expand(context, component.name(), component.component.parameters());
                (struct_name(component), docs::of_component(context, topology, component), parameters)
            }
            Side::Counterpart => (counterpart_name(component), docs::of_counterpart(component.name()), None),
        };
        let (types, parameters) = parameters.unzip();
        let expanded = expand_struct(context, &name, &doc, &parameters.into_iter().chain(fields).collect::<Vec<_>>());
        quote!(#expanded #types)
    });
    quote!(#own #for_tests #counterpart)
}

/// The implementations of `scl::Component` for both structs.
///
/// `Controller::test()` opens a `Controller` and a `ControllerPeer` that are connected within the process. All of the
/// counterpart is `#[cfg(test)]` in the crate that invokes the macro, so other builds do not compile it, unless it is
/// `testable`.
fn expand_implementation(
    context: &Context<'_>,
    topology: &Topology,
    component: ComponentType<'_>,
    plan: &Plan,
    codec_traits: &CodecTraits<'_>,
    schemas: &EmbeddedSchemas<'_>,
    requirements: &Requirements,
) -> TokenStream {
    let (private, for_tests) = (&context.private, &context.for_tests);
    let (name, peer) = (struct_name(component), counterpart_name(component));
    let implementation = |name: &Ident, constants: TokenStream, side: Side| {
        let methods = expand_methods(context, topology, component, codec_traits, side);
        quote_spanned! { context.span =>
            impl #private::Component for #name {
                #constants
                #methods
            }
        }
    };
    let spec = |plan, schemas| {
        let spec = expand_spec(context, plan, schemas);
        quote_spanned!(context.span => const SPEC: &'static #private::ComponentSpec = &#spec;)
    };
    let mut constants = spec(plan, schemas);
    constants.extend(component.kind.map(|it| kind::expand_constant(context, topology, it)));
    let own = implementation(&name, constants, Side::Component);
    let counterpart = spec(&plan.counterpart(), &EmbeddedSchemas::default());
    let counterpart = implementation(&peer, counterpart, Side::Counterpart);
    let bounds = requirements.expand_bounds(context, topology, component.component);
    let kind_methods = component.kind.map(|kind| {
        let instance = instance_name(kind.name());
        quote_spanned!(context.span => #private::kind_methods!(#name, #instance #bounds);)
    });
    quote_spanned! { context.span =>
        #own
        #private::component_methods!(#name #bounds);
        #kind_methods
        #private::component_main_functions!(#name #bounds);
        #for_tests
        #counterpart
        #for_tests
        #private::component_test_methods!(#name, #peer #bounds);
    }
}
