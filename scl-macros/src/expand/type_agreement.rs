//! `SCL0605`: rustc checks that the two ends of a connection have one message type.
//!
//! Without `schemas:`, two different names in the file may be one Rust type, for example through an alias. Only rustc
//! can tell, so each such connection becomes a function that compiles only if its two types are equal.

use super::context::Context;
use super::gate_types::message_type;
use super::rustc_notes::{escape_braces, note_with_excerpt, on_unimplemented};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use scl_topology::topology::{Connection, GateKind, Payload, Topology, TypeName};
use syn::Ident;

/// The checks of all connections whose ends name their types differently.
pub(super) fn expand_agreements(context: &Context<'_>, topology: &Topology) -> TokenStream {
    let connections = topology.connections().map(|(_, connection)| connection);
    let agreements =
        connections.filter(|connection| includes_both_ends(context, topology, connection)).flat_map(|it| {
            let differing = differing_types(topology, it).into_iter();
            differing.map(move |types| expand_agreement(context, topology, it, types))
        });
    quote! { #(#agreements)* }
}

/// Returns true if the components at both ends are generated. Others belong to other programs, whose types need not
/// exist in this one.
fn includes_both_ends(context: &Context<'_>, topology: &Topology, connection: &Connection) -> bool {
    [connection.source(), connection.sink()]
        .iter()
        .all(|&gate| context.includes(topology.type_of(topology.gate(gate).component()).name()))
}

/// The pairs of types at the source and at the sink whose names differ.
fn differing_types<'a>(topology: &'a Topology, connection: &Connection) -> Vec<(&'a TypeName, &'a TypeName)> {
    let ends = (topology.gate(connection.source()).payload(), topology.gate(connection.sink()).payload());
    let pairs = match ends {
        (Payload::Message(a), Payload::Message(b)) => vec![(a, b)],
        (Payload::Exchange { request: a, reply: c }, Payload::Exchange { request: b, reply: d }) => {
            vec![(a, b), (c, d)]
        }
        _ => Vec::new(),
    };
    pairs.into_iter().filter(|(a, b)| a.dotted() != b.dotted()).collect()
}

fn expand_agreement(
    context: &Context<'_>,
    topology: &Topology,
    connection: &Connection,
    (at_source, at_sink): (&TypeName, &TypeName),
) -> TokenStream {
    let (source, sink) = (connection.source(), connection.sink());
    let ends = format!("`{}` -> `{}`", topology.gate_path(source), topology.gate_path(sink));
    let message = escape_braces(&format!("[SCL0605] message types disagree on connection {ends}"));
    let phrases = match topology.gate(source).kind() {
        GateKind::Pub => ["is published", "is expected"],
        GateKind::Push => ["is pushed", "is expected"],
        _ => ["is the type of the requester", "is the type of the replier"],
    };
    let shown = |name: &TypeName| context.types.shown(name.dotted());
    let label = format!("`{}` {}, `{}` {}", shown(at_source), phrases[0], shown(at_sink), phrases[1]);
    let declaration = note_with_excerpt(context, "they are connected here", connection.span());
    let report = on_unimplemented(&message, &label, &[declaration]);
    let lookups = context.types.lookups();
    let stand_in = lookups.stand_in(at_source).or(lookups.stand_in(at_sink));
    let (sent, received) = (message_type(context, at_source.dotted()), message_type(context, at_sink.dotted()));
    let unless_missing = stand_in.map(|stand_in| expand_exceptions(context, stand_in));
    quote_spanned! { context.span =>
        #[allow(dead_code, private_interfaces, clippy::all, clippy::pedantic)]
        const _: () = {
            #report
            trait SameTypeAs<Other> {}
            impl<Same> SameTypeAs<Same> for Same {}
            struct Connection<Sent, Received>(::core::marker::PhantomData<(Sent, Received)>);
            trait Check<Sent, Received> {
                fn check(&self) where Sent: SameTypeAs<Received>;
            }
            impl<Sent, Received> Check<Sent, Received> for Connection<Sent, Received> {
                fn check(&self) where Sent: SameTypeAs<Received> {}
            }
            #unless_missing
            fn types_agree() {
                Connection::<#sent, #received>(::core::marker::PhantomData).check()
            }
        };
    }
}

/// Expands methods that skip the check for a type that is not found: it belongs to another program, where it is
/// compared. They take precedence because they take the connection by value, and the first one over the second because
/// it belongs to no trait.
fn expand_exceptions(context: &Context<'_>, stand_in: &Ident) -> TokenStream {
    quote_spanned! { context.span =>
        impl<Received> Connection<#stand_in, Received> {
            fn check(self) {}
        }
        trait Skip: ::core::marker::Sized {
            fn check(self) {}
        }
        impl<Sent> Skip for Connection<Sent, #stand_in> {}
    }
}
