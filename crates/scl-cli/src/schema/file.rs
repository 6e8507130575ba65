//! The schema of the file: its sections, and the keys of a component.

use super::gate::{gate_schema, shared_gate_schema};
use super::names::{FULL_NAME, NAME, Names, PATH};
use super::parameter::parameter_schema;
use super::shape::shape_schema;
use scl_topology::grammar::{
    COMPONENT_KEYS, INCLUDE_KEYS, Item, KIND, Key, OWN_PREFIX, SECTIONS, Shape, without_references,
};
use serde_json::{Map, Value, json};

/// The whole schema.
pub(super) fn file_schema(names: &Names) -> Value {
    let mut schema = mapping(&SECTIONS, names);
    // A file that another one includes need not have any section.
    schema.remove("required");
    let head = json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "SCL topology",
        "description": "Which components exist, which gates they have, and which gates are connected.",
        "patternProperties": { format!("^{OWN_PREFIX}"): { "description": "For your own use; ignored." } },
    });
    schema.extend(head.as_object().cloned().unwrap_or_default());
    Value::Object(schema)
}

/// A mapping with these keys.
fn mapping(keys: &[Key], names: &Names) -> Map<String, Value> {
    let properties: Map<String, Value> = keys.iter().map(|key| (key.key.to_owned(), key_schema(key, names))).collect();
    let required: Vec<&str> = keys.iter().filter(|key| key.is_required()).map(|key| key.key).collect();
    let schema = json!({
        "type": "object", "required": required, "properties": properties, "additionalProperties": false,
    });
    schema.as_object().cloned().unwrap_or_default()
}

fn key_schema(key: &Key, names: &Names) -> Value {
    let mut schema = match key.shape {
        Shape::List(item) => list_schema(key, item, names),
        Shape::Name if key.key == KIND => names.kind_schema(),
        Shape::Name if key.key == "name" => json!({ "type": "string", "pattern": FULL_NAME }),
        Shape::Name => json!({ "type": "string", "pattern": NAME }),
        other => shape_schema(other),
    };
    schema["description"] = json!(format!("{} {}", key.summary, without_references(key.text)).trim_end());
    schema
}

fn list_schema(key: &Key, item: Item, names: &Names) -> Value {
    let items = match item {
        Item::Component => component_schema(&COMPONENT_KEYS, "A component: one program, or a part of one.", names),
        Item::Kind => {
            let [keys @ .., _kind] = &COMPONENT_KEYS;
            component_schema(keys, "A kind: what its components have in common.", names)
        }
        Item::Connection => connection_schema(names),
        Item::File => {
            json!({ "type": "string", "pattern": "\\S", "description": "A file, for example `rover.proto`." })
        }
        Item::Folder => {
            json!({ "type": "string", "pattern": "\\S", "description": "A folder, for example `proto`." })
        }
        Item::Gate => gate_schema(names),
        Item::Parameter => parameter_schema(),
        Item::SharedGate => shared_gate_schema(names),
        Item::Topology => include_schema(),
        Item::Export => return exports_schema(),
    };
    // A list of components or gates that is still empty is a warning, not an error.
    match (key.is_required(), item) {
        (true, _) | (_, Item::File | Item::Folder | Item::Topology) => json!({ "type": "array", "items": items }),
        (false, _) => json!({ "type": ["array", "null"], "items": items }),
    }
}

/// A file, or a file that becomes a group.
fn include_schema() -> Value {
    let path = json!({ "type": "string", "pattern": "\\S", "description": "A file, for example `sensors.yaml`." });
    let [file, group] = INCLUDE_KEYS;
    let entry = json!({
        "type": "object",
        "description": "A file, which becomes a group with `as`.",
        "properties": { file: path, group: { "type": "string", "pattern": FULL_NAME, "description": "The group." } },
        "required": [file],
        "additionalProperties": false,
    });
    json!({ "anyOf": [path, entry] })
}

/// Names for the outside, each with its gate.
fn exports_schema() -> Value {
    let entries = json!({
        "type": "object",
        "propertyNames": { "pattern": NAME },
        "additionalProperties": { "type": "string", "pattern": PATH },
    });
    json!({ "anyOf": [entries, { "type": "array", "items": entries }, { "type": "null" }] })
}

fn component_schema(keys: &[Key], description: &str, names: &Names) -> Value {
    let mut schema = mapping(keys, names);
    schema.insert("description".to_owned(), json!(description));
    Value::Object(schema)
}

fn connection_schema(names: &Names) -> Value {
    json!({
        "description": "A connection: two gates, `[component.gate, component.gate]`; `each kind.gate` stands for the gate \
                        of all components of a kind.",
        "type": "array", "minItems": 2, "maxItems": 2, "items": names.end_schema(),
    })
}
