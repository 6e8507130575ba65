//! The constants that the runtime needs, from the plan of a component: `ComponentSpec`, `GateSpec`, `LinkSpec`.

use super::context::Context;
use super::schemas::EmbeddedSchemas;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use scl_plan::{ConnectionPlan, GatePlan, Plan};
use std::fmt::Debug;
use std::time::Duration;
use syn::Ident;

/// The `ComponentSpec` of a component or of its counterpart.
pub(super) fn expand_spec(context: &Context<'_>, plan: &Plan, schemas: &EmbeddedSchemas<'_>) -> TokenStream {
    let private = &context.private;
    let Plan { system, component, declared_at, schema, gates } = plan;
    let gates = gates.iter().map(|gate| expand_gate(private, gate));
    let schema = schemas.expand_reference(schema.as_ref());
    quote! {
        #private::ComponentSpec {
            system: #system, name: #component, declared_at: #declared_at, gates: &[#(#gates),*], schema: #schema,
        }
    }
}

fn expand_gate(private: &TokenStream, gate: &GatePlan) -> TokenStream {
    let GatePlan { name, codec, declared_at, contract, max_size, queue, backpressure, .. } = gate;
    let (kind, when_full) = (variant(gate.kind), variant(gate.when_full));
    let payload = gate.payload.to_string();
    let [endpoint, tap] = [&gate.endpoint, &gate.tap].map(|name| name.as_deref().unwrap_or_default());
    let timeout = expand_duration(private, gate.timeout);
    let links = gate.connections.iter().map(|connection| expand_link(private, connection));
    quote! {
        #private::GateSpec {
            name: #name, kind: #private::GateKind::#kind, payload: #payload, codec: #codec, declared_at: #declared_at,
            endpoint: #endpoint, tap: #tap, contract: #contract, max_size: #max_size,
            queue: #queue, when_full: #private::WhenFull::#when_full, backpressure: #backpressure, timeout: #timeout,
            links: &[#(#links),*],
        }
    }
}

fn expand_link(private: &TokenStream, connection: &ConnectionPlan) -> TokenStream {
    let ConnectionPlan { peer_component, peer_gate, endpoint, contract, required, queue, when_full, max_size } =
        connection;
    let when_full = variant(when_full);
    quote! {
        #private::LinkSpec {
            peer_component: #peer_component, peer_gate: #peer_gate, endpoint: #endpoint, contract: #contract,
            required: #required, queue: #queue, when_full: #private::WhenFull::#when_full, max_size: #max_size,
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
