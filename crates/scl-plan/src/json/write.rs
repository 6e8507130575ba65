//! From plans to JSON.

use super::text::Json;
use crate::base64;
use crate::options::{GateOptions, OptionAccess};
use crate::plan::{ConnectionPlan, GatePlan, Payload, Plan};
use crate::system::SystemPlan;
use crate::version::VERSION;
use std::collections::BTreeMap;

impl SystemPlan {
    /// The plans as JSON, indented, with a line break at the end.
    pub fn to_json(&self) -> String {
        document(&self.system, &self.components)
    }
}

impl Plan {
    /// The plan as JSON: a document with one component.
    pub fn to_json(&self) -> String {
        document(&self.system, std::slice::from_ref(self))
    }
}

fn document(system: &str, components: &[Plan]) -> String {
    let schemas: BTreeMap<&str, &[u8]> = components
        .iter()
        .filter_map(|plan| plan.schema.as_ref())
        .map(|schema| (schema.hash.as_str(), &*schema.descriptors))
        .collect();
    let schemas = schemas.into_iter().map(|(hash, bytes)| (hash.to_owned(), Json::Text(base64::encode(bytes))));
    let document = Json::object([
        ("version", Json::Number(VERSION)),
        ("system", Json::text(system)),
        ("components", Json::List(components.iter().map(component).collect())),
        ("schemas", Json::Object(schemas.collect())),
    ]);
    let mut text = String::new();
    document.write(0, &mut text);
    text.push('\n');
    text
}

fn component(plan: &Plan) -> Json {
    Json::object([
        ("name", Json::text(&plan.component)),
        ("declared_at", Json::text(&plan.declared_at)),
        ("schema", Json::or_null(plan.schema.as_ref().map(|schema| schema.hash.as_str()))),
        ("gates", Json::List(plan.gates.iter().map(gate).collect())),
    ])
}

fn gate(gate: &GatePlan) -> Json {
    let own = [
        ("name", Json::text(&gate.name)),
        ("kind", Json::text(gate.kind.word())),
        ("payload", payload(&gate.payload)),
        ("codec", Json::text(&gate.codec)),
        ("declared_at", Json::text(&gate.declared_at)),
        ("endpoint", Json::or_null(gate.endpoint.as_deref())),
        ("tap", Json::or_null(gate.tap.as_deref())),
        ("contract", Json::text(&gate.contract)),
    ];
    let options = GateOptions::ALL.map(|field| (field.json, option(gate.options.clone(), field.access)));
    let connections = ("connections", Json::List(gate.connections.iter().map(connection).collect()));
    Json::object(own.into_iter().chain(options).chain([connections]))
}

fn option(mut options: GateOptions, access: OptionAccess) -> Json {
    match access {
        OptionAccess::Number(number) => Json::Number((*number(&mut options)).into()),
        OptionAccess::Size(size) => Json::Number(*size(&mut options)),
        // A duration of over 584 years is none that `validate` accepts.
        OptionAccess::Duration(duration) => {
            Json::Number(u64::try_from(duration(&mut options).as_nanos()).unwrap_or(u64::MAX))
        }
        OptionAccess::Flag(flag) => Json::Bool(*flag(&mut options)),
        OptionAccess::Policy(policy) => Json::text(policy(&mut options).word()),
        OptionAccess::Undecodable(choice) => Json::text(choice(&mut options).word()),
    }
}

fn payload(payload: &Payload) -> Json {
    match payload {
        Payload::Bytes => Json::Null,
        Payload::Message(name) => Json::object([("message", Json::text(name))]),
        Payload::Exchange { request, reply } => {
            Json::object([("request", Json::text(request)), ("reply", Json::text(reply))])
        }
    }
}

fn connection(connection: &ConnectionPlan) -> Json {
    Json::object([
        ("peer_component", Json::text(&connection.peer_component)),
        ("peer_gate", Json::text(&connection.peer_gate)),
        ("endpoint", Json::text(&connection.endpoint)),
        ("contract", Json::text(&connection.contract)),
        ("required", Json::Bool(connection.required)),
        ("queue", Json::Number(connection.queue.into())),
        ("when_full", Json::text(connection.when_full.word())),
        ("max_size", Json::Number(connection.max_size)),
    ])
}
