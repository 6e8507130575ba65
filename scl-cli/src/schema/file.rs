//! The schema of the file: its sections, components and connections.

use super::gate::gate_schema;
use super::names::{NAME, Names};
use scl_topology::topology::Codec;
use serde_json::{Value, json};

/// The whole schema.
pub(super) fn file_schema(names: &Names) -> Value {
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "SCL topology",
        "description": "Which components exist, which gates they have, and which gates are connected.",
        "type": "object",
        "required": ["components"],
        "properties": {
            "components": {
                "description": "The components, each with its gates.",
                "type": "array", "minItems": 1, "items": component_schema(names),
            },
            "connections": {
                "description": "Which gates are connected. The order of the two ends is free: their kinds say which one sends.",
                "type": ["array", "null"], "items": connection_schema(names),
            },
            "system": {
                "description": "The name of the system. Default: the file's name without its ending.",
                "type": "string",
            },
            "schemas": {
                "description": "Protobuf files beside this one, from which the macro makes Rust types.",
                "type": "array", "items": { "type": "string", "description": "A file, for example `rover.proto`." },
            },
            "codec": codec_schema("The codec of typed gates that name none. Default: `protobuf`."),
            "scl": { "description": "The version of the file's format.", "type": "integer", "enum": [1] },
        },
        "patternProperties": { "^x-": { "description": "For your own use; ignored." } },
        "additionalProperties": false,
    })
}

/// A codec of the framework, or a Rust path to one of the user's own.
pub(super) fn codec_schema(description: &str) -> Value {
    let known = Codec::BUILT_IN;
    let known = known.each_ref().map(Codec::word);
    let words: [&str; Codec::BUILT_IN.len()] = [
        "Messages of a schema, or any prost type.",
        "Any serde type, as text.",
        "Any serde type, binary.",
        "Any serde type, binary.",
        "Any serde type, binary and small, between Rust programs.",
        "A fixed layout, or bytes.",
    ];
    json!({
        "description": description,
        "anyOf": [
            { "type": "string", "enum": known, "enumDescriptions": words },
            { "type": "string", "pattern": "::", "description": "A codec of your own: `my_crate::Flat`." },
        ],
    })
}

fn component_schema(names: &Names) -> Value {
    json!({
        "type": "object",
        "description": "A component: one program, or a part of one.",
        "required": ["name"],
        "properties": {
            "name": {
                "description": "The name, in snake_case: `user_interface` becomes the Rust type `UserInterface`.",
                "type": "string", "pattern": NAME,
            },
            "gates": {
                "description": "The gates, each a field of the component's Rust type.",
                "type": ["array", "null"], "items": gate_schema(names),
            },
            "doc": { "description": "One paragraph for the generated documentation.", "type": "string" },
            "optional": {
                "description": "Peers do not wait for this component at start.",
                "type": "boolean", "default": false,
            },
        },
        "additionalProperties": false,
    })
}

fn connection_schema(names: &Names) -> Value {
    json!({
        "description": "A connection: two gates, `[component.gate, component.gate]`.",
        "type": "array", "minItems": 2, "maxItems": 2, "items": names.end_schema(),
    })
}
