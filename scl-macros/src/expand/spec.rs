//! The constants that the runtime needs, from the plan of a component: `ComponentSpec`, `GateSpec`, `ConnectionSpec`.

use super::context::Context;
use super::parameters::expand_plan;
use super::schemas::EmbeddedSchemas;
use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};
use scl_plan::{ConnectionPlan, GateOptions, GatePlan, OptionAccess, Plan};
use std::fmt::Debug;
use std::time::Duration;
use syn::Ident;

/// The `ComponentSpec` of a component or of its counterpart.
pub(super) fn expand_spec(context: &Context<'_>, plan: &Plan, schemas: &EmbeddedSchemas<'_>) -> TokenStream {
    let private = &context.private;
    let Plan { system, component, declared_at, schema, parameters, gates } = plan;
    let parameters = parameters.iter().map(|parameter| expand_plan(private, parameter));
    let gates = gates.iter().map(|gate| expand_gate(private, gate));
    let schema = schemas.expand_reference(schema.as_ref());
    quote! {
        #private::ComponentSpec {
            system: #system, name: #component, declared_at: #declared_at, parameters: &[#(#parameters),*],
            gates: &[#(#gates),*], schema: #schema,
        }
    }
}

fn expand_gate(private: &TokenStream, gate: &GatePlan) -> TokenStream {
    let GatePlan { name, codec, declared_at, contract, .. } = gate;
    let kind = variant(gate.kind);
    let payload = gate.payload.to_string();
    let [endpoint, tap] = [&gate.endpoint, &gate.tap].map(|name| name.as_deref().unwrap_or_default());
    let options = expand_options(private, &gate.options);
    let connections = gate.connections.iter().map(|connection| expand_connection(private, connection));
    quote! {
        #private::GateSpec {
            name: #name, kind: #private::GateKind::#kind, payload: #payload, codec: #codec, declared_at: #declared_at,
            endpoint: #endpoint, tap: #tap, contract: #contract, options: #options,
            connections: &[#(#connections),*],
        }
    }
}

/// The options that differ from their defaults.
fn expand_options(private: &TokenStream, options: &GateOptions) -> TokenStream {
    let fields = GateOptions::ALL.iter().filter_map(|option| {
        let value = expand_option(private, options, option.access)?;
        let name = format_ident!("{}", option.key);
        Some(quote!(#name: #value,))
    });
    quote!(#private::GateOptions { #(#fields)* ..#private::GateOptions::DEFAULT })
}

/// The value of an option, unless it is the default.
fn expand_option(private: &TokenStream, options: &GateOptions, access: OptionAccess) -> Option<TokenStream> {
    fn changed<T: PartialEq + Clone>(options: &GateOptions, get: fn(&mut GateOptions) -> &mut T) -> Option<T> {
        let [ours, default] = [options, &GateOptions::DEFAULT].map(|options| get(&mut options.clone()).clone());
        (ours != default).then_some(ours)
    }
    Some(match access {
        OptionAccess::Number(get) => changed(options, get)?.to_token_stream(),
        OptionAccess::Size(get) => changed(options, get)?.to_token_stream(),
        OptionAccess::Duration(get) => expand_duration(private, changed(options, get)?),
        OptionAccess::Interval(get) => {
            let interval = expand_duration(private, changed(options, get)??);
            quote!(::core::option::Option::Some(#interval))
        }
        OptionAccess::Flag(get) => changed(options, get)?.to_token_stream(),
        OptionAccess::Policy(get) => {
            let policy = variant(changed(options, get)?);
            quote!(#private::WhenFull::#policy)
        }
        OptionAccess::Undecodable(get) => {
            let choice = variant(changed(options, get)?);
            quote!(#private::Undecodable::#choice)
        }
    })
}

fn expand_connection(private: &TokenStream, connection: &ConnectionPlan) -> TokenStream {
    let ConnectionPlan { peer_component, peer_gate, endpoint, contract, required, queue, when_full, max_size, max_age } =
        connection;
    let max_age = match max_age {
        Some(max_age) => {
            let max_age = expand_duration(private, *max_age);
            quote!(Some(#max_age))
        }
        None => quote!(None),
    };
    let when_full = variant(when_full);
    quote! {
        #private::ConnectionSpec {
            peer_component: #peer_component, peer_gate: #peer_gate, endpoint: #endpoint, contract: #contract,
            required: #required, queue: #queue, when_full: #private::WhenFull::#when_full, max_size: #max_size,
            max_age: ::core::option::Option::#max_age,
        }
    }
}

/// The name of a variant without fields, which is what `Debug` prints.
fn variant(value: impl Debug) -> Ident {
    format_ident!("{}", format!("{value:?}"))
}

fn expand_duration(private: &TokenStream, duration: Duration) -> TokenStream {
    let (seconds, nanoseconds) = (duration.as_secs(), duration.subsec_nanos());
    quote!(#private::Duration::new(#seconds, #nanoseconds))
}
