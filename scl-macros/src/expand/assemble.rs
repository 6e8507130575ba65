//! The methods of `scl::Component`: opening the gates of a struct and listing them.

use super::codec_traits::{CodecTrait, CodecTraits};
use super::context::Context;
use super::gate_types::bytes;
use super::kinds::opener_method;
use super::names::field_name;
use super::parameters::expand_values;
use proc_macro2::TokenStream;
use quote::quote_spanned;
use scl_topology::topology::{Component, ComponentType, GateKind, Topology};

/// Which end of a gate's connections a struct has.
#[derive(Clone, Copy)]
pub(super) enum Side {
    /// The component itself.
    Component,
    /// Its counterpart in unit tests.
    Counterpart,
}

impl Side {
    /// The kind that a gate of the component has on this side.
    pub(super) fn kind(self, own: GateKind) -> GateKind {
        match self {
            Side::Component => own,
            Side::Counterpart => own.opposite(),
        }
    }
}

/// `assemble`, `gates` and `handle` of a struct that has one field for each gate of the component.
pub(super) fn expand_methods(
    context: &Context<'_>,
    topology: &Topology,
    of: ComponentType<'_>,
    traits: &CodecTraits<'_>,
    side: Side,
) -> TokenStream {
    let component = of.component;
    let private = &context.private;
    let parameters = match side {
        Side::Component => expand_values(context, of.name(), component.parameters()),
        Side::Counterpart => None,
    };
    let opened = expand_opened(context, topology, component, traits, side);
    let opened = parameters.into_iter().chain(opened);
    let fields = component.gates().iter().map(|&id| field_name(topology.gate(id)));
    let gates = fields.map(|field| quote_spanned!(context.span => &self.#field as &dyn #private::AnyGate));
    quote_spanned! { context.span =>
        fn assemble(__opener: &mut #private::Opener) -> ::core::result::Result<Self, #private::OpenError> {
            ::core::result::Result::Ok(Self { #(#opened,)* __scl: __opener.handle() })
        }
        fn gates(&self) -> ::std::vec::Vec<&dyn #private::AnyGate> {
            ::std::vec::Vec::from([#(#gates),*])
        }
        fn handle(&self) -> &#private::ComponentHandle {
            &self.__scl
        }
    }
}

/// The gate fields of `Self { .. }`. Each gate is opened by its index in the specification.
fn expand_opened(
    context: &Context<'_>,
    topology: &Topology,
    component: &Component,
    traits: &CodecTraits<'_>,
    side: Side,
) -> Vec<TokenStream> {
    let private = &context.private;
    let fields = component.gates().iter().enumerate().map(|(index, &id)| {
        let gate = topology.gate(id);
        let field = field_name(gate);
        let kind = side.kind(gate.kind());
        let method = opener_method(kind, context.span);
        // The enum is inferred from the struct, too.
        let with_senders = match side {
            Side::Component => topology.senders(id).map(|_| quote_spanned!(context.span => .with_senders()?)),
            Side::Counterpart => None,
        };
        match traits.of(gate) {
            // The message types are inferred from the struct, so a wrong type is reported only once, at the struct.
            Some(CodecTrait { name, .. }) => {
                quote_spanned! { context.span => #field: #name::#method(__opener, #index)? #with_senders }
            }
            None => {
                let bytes = bytes(context, kind);
                quote_spanned! { context.span =>
                    #field: __opener.#method::<#bytes, #private::codec::Opaque>(#index)? #with_senders
                }
            }
        }
    });
    fields.collect()
}
