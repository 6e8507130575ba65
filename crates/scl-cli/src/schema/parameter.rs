//! The schema of a parameter: a type, or a type with its default and more.

use super::gate::named;
use scl_plan::Scalar;
use scl_topology::grammar::parameter::{LIST, ONE_OF};
use serde_json::{Value, json};

/// A parameter: `name: type`, or `name: {type: default, range: [least, largest]}`.
pub(super) fn parameter_schema() -> Value {
    let short = json!({ "type": "string", "enum": Scalar::WORDS, "description": "The type. A value must be given." });
    let scalars = Scalar::ALL.into_iter().map(|scalar| {
        let value = json!({ "type": value_types(scalar), "description": "The default, or nothing." });
        let schema = long_schema(scalar.word(), value);
        with_bounds(schema, scalar.has_range(), scalar.is_number())
    });
    let words = json!({ "type": "array", "items": { "type": "string" }, "minItems": 1, "description": "The words." });
    let mut choice = long_schema(ONE_OF, words);
    choice["properties"]["default"] = json!({ "type": "string", "description": "The default, one of the words." });
    let of = json!({ "type": "string", "enum": Scalar::WORDS, "description": "The type of the items." });
    let mut list = with_bounds(long_schema(LIST, of), true, true);
    list["properties"]["length"] = json!({
        "type": "integer", "minimum": 1, "maximum": 10_000, "description": "The number of items; any without it.",
    });
    let any = json!({ "type": ["string", "number", "boolean"] });
    list["properties"]["default"] = json!({ "type": "array", "items": any, "description": "The default." });
    let forms = [short].into_iter().chain(scalars).chain([choice, list]).collect();
    named("A parameter: `name: type`, or `name: {type: default}`.", forms)
}

fn long_schema(word: &str, value: Value) -> Value {
    json!({
        "type": "object",
        "title": format!("{word} parameter"),
        "required": [word],
        "properties": {
            word: value,
            "doc": { "type": "string", "description": "A sentence for people." },
            "live": { "type": "boolean", "description": "Whether it can be changed while the program runs." },
        },
        "additionalProperties": false,
    })
}

/// Adds the keys of values that have an order, and of numbers.
fn with_bounds(mut schema: Value, has_range: bool, has_unit: bool) -> Value {
    if has_range {
        schema["properties"]["range"] = json!({
            "type": "array", "minItems": 2, "maxItems": 2, "items": { "type": ["string", "number"] },
            "description": "The least and the largest value.",
        });
    }
    if has_unit {
        schema["properties"]["unit"] = json!({ "type": "string", "description": "The unit, for people: `m/s`." });
    }
    schema
}

/// What a default may be in YAML; nothing if there is none.
fn value_types(scalar: Scalar) -> Value {
    match scalar {
        Scalar::Bool => json!(["boolean", "null"]),
        Scalar::Duration => json!(["string", "null"]),
        Scalar::Text => json!(["string", "number", "boolean", "null"]),
        Scalar::F32 | Scalar::F64 => json!(["number", "null"]),
        _ => json!(["integer", "null"]),
    }
}
