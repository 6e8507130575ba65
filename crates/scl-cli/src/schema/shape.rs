//! The schema of a single value.

use scl_text::{duration, rate, size};
use scl_topology::grammar::{Codec, Shape};
use serde_json::{Value, json};

/// Pattern of a Rust path with at least one `::`.
const RUST_PATH: &str = "^(::[A-Za-z_][A-Za-z0-9_]*|[A-Za-z_][A-Za-z0-9_]*::[A-Za-z_][A-Za-z0-9_]*)\
                         (::[A-Za-z_][A-Za-z0-9_]*)*$";

/// Returns the schema of a value. It cannot express everything: `True` and `0x10`, which the checker refuses, are
/// `true` and 16 to a YAML parser.
pub(super) fn shape_schema(shape: Shape) -> Value {
    match shape {
        // YAML may read an unquoted text as a number or a boolean.
        Shape::Text => json!({ "type": ["string", "number", "boolean"], "pattern": "\\S" }),
        Shape::Name => json!({ "type": "string", "pattern": "\\S" }),
        Shape::Codec => codec_schema(),
        Shape::Number { least, most } => json!({ "type": "integer", "minimum": least, "maximum": most }),
        Shape::Duration { .. } => decimal_schema(&duration::UNITS.map(|(unit, _)| unit)),
        Shape::Rate { .. } => decimal_schema(&rate::UNITS.map(|(unit, _)| unit)),
        Shape::Size { .. } => {
            let units = size::UNITS.map(|(unit, _)| unit).join("|");
            json!({ "type": "string", "pattern": format!("^\\s*\\+?[0-9]+\\s*({units})\\s*$") })
        }
        Shape::Boolean => json!({ "type": "boolean" }),
        Shape::Word(words) => {
            let summaries: Vec<&str> = words.iter().map(|word| word.summary).collect();
            let words: Vec<&str> = words.iter().map(|word| word.word).collect();
            json!({ "type": "string", "enum": words, "enumDescriptions": summaries })
        }
        Shape::List(_) => json!({ "type": "array" }),
    }
}

/// A number, perhaps with a fraction, and one of these units.
fn decimal_schema(units: &[&str]) -> Value {
    let units = units.join("|");
    json!({ "type": "string", "pattern": format!("^\\s*\\+?([0-9]+\\.?[0-9]*|\\.[0-9]+)\\s*({units})$") })
}

/// A codec of the framework, or a Rust path to one of the user's own.
fn codec_schema() -> Value {
    let words: Vec<&str> = Codec::words().collect();
    let summaries: Vec<&str> = Codec::BUILT_IN.iter().map(|row| row.summary).collect();
    json!({
        "anyOf": [
            { "type": "string", "enum": words, "enumDescriptions": summaries },
            { "type": "string", "pattern": RUST_PATH, "description": "A codec of your own: `my_crate::Flat`." },
        ],
    })
}
