//! The schema of a gate: six kinds, each with its options.

use super::names::{FULL_NAME, NAME, Names, PATH};
use super::shape::shape_schema;
use scl_topology::grammar::{GateKind, GateOption, KindRow, OPTIONS, SHARED_GATE_KEYS, without_references};
use serde_json::{Map, Value, json};

/// A gate: `name: kind`, or `name: {kind: type, option: value}`.
pub(super) fn gate_schema(names: &Names) -> Value {
    let long = GateKind::ALL.map(|kind| long_schema(kind, names));
    let short = json!({
        "type": "string",
        "enum": GateKind::ALL.map(GateKind::word),
        "enumDescriptions": GateKind::ALL.map(|kind| KindRow::of(kind).summary),
        "description": "The kind of the gate. Its type is taken from the other end, or it carries bytes.",
    });
    let forms = std::iter::once(short).chain(long).collect();
    named("A gate: `name: kind`, or `name: {kind: type, option: value}`.", forms)
}

/// A gate of `everyone`: `name: {kind: type, to: component.gate}`.
pub(super) fn shared_gate_schema(names: &Names) -> Value {
    let forms = GateKind::ALL.map(|kind| {
        let mut schema = long_schema(kind, names);
        let [to, except] = SHARED_GATE_KEYS;
        schema["required"] = json!([kind.word(), to]);
        let end = "The gate at the other end: `component.gate`.";
        schema["properties"][to] = json!({ "type": "string", "pattern": PATH, "description": end });
        schema["properties"][except] = json!({
            "description": "The components and kinds that do not get the gate.",
            "type": ["string", "array"], "pattern": FULL_NAME, "items": { "type": "string", "pattern": FULL_NAME },
        });
        schema
    });
    named("A gate of every component: `name: {kind: type, to: component.gate}`.", forms.to_vec())
}

/// A mapping from a name to one of these forms.
pub(super) fn named(description: &str, forms: Vec<Value>) -> Value {
    json!({
        "type": "object",
        "description": description,
        "propertyNames": { "pattern": NAME },
        "minProperties": 1,
        "maxProperties": 1,
        "additionalProperties": { "anyOf": forms },
    })
}

/// Returns the schema of the long form of a gate: `{sub: rover.Measurement, queue: 1}`.
fn long_schema(kind: GateKind, names: &Names) -> Value {
    let summary = KindRow::of(kind).summary;
    let payload = match kind.exchanges() {
        true => names.exchange_schema(&format!(
            "{summary} Value: request and reply, for example `rover.Command -> rover.Status`, or nothing."
        )),
        false => {
            names.message_schema(&format!("{summary} Value: the type, for example `rover.Measurement`, or nothing."))
        }
    };
    let mut properties = Map::from_iter([(kind.word().to_owned(), payload)]);
    for option in OPTIONS.iter().filter(|option| option.fits(kind)) {
        properties.insert(option.key.to_owned(), option_schema(option));
    }
    json!({
        "type": "object",
        "title": format!("{} gate", kind.word()),
        "description": summary,
        "required": [kind.word()],
        "properties": properties,
        "additionalProperties": false,
    })
}

fn option_schema(option: &GateOption) -> Value {
    let mut schema = shape_schema(option.shape);
    let default = option.default();
    let told = default.as_ref().map_or(String::new(), |default| format!(" Default: `{default}`."));
    let values = option.shape.values();
    schema["description"] =
        json!(format!("{} {} Value: {values}.{told}", option.summary, without_references(option.text)));
    if let Some(default) = default {
        // Numbers and booleans stay JSON values; durations, sizes and words become strings.
        schema["default"] = serde_json::from_str(&default).unwrap_or_else(|_| json!(default));
    }
    schema
}
