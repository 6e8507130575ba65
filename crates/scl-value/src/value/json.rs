//! Values as JSON.

use super::{Value, key_text};
use crate::base64::to_base64;
use scl_terminal::escape_json;
use serde::ser::{Serialize, SerializeMap, SerializeSeq, Serializer};

/// A value as JSON on one line. Bytes are base64, NaN and infinities are texts, as in protobuf's JSON; keys are texts.
///
/// All characters that a terminal could act on are escaped.
pub fn to_json(value: &Value) -> String {
    // Writing to memory cannot fail, and `Json` has an answer for every value.
    escape_json(&serde_json::to_string(&Json(value)).unwrap_or_default()).into_owned()
}

struct Json<'v>(&'v Value);

impl Serialize for Json<'_> {
    fn serialize<S: Serializer>(&self, output: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Value::Null => output.serialize_unit(),
            Value::Bool(flag) => output.serialize_bool(*flag),
            Value::Int(number) => output.serialize_i64(*number),
            Value::Uint(number) => output.serialize_u64(*number),
            Value::Float(number) if number.is_nan() => output.serialize_str("NaN"),
            Value::Float(f64::INFINITY) => output.serialize_str("Infinity"),
            Value::Float(f64::NEG_INFINITY) => output.serialize_str("-Infinity"),
            Value::Float(number) => output.serialize_f64(*number),
            Value::Text(text) => output.serialize_str(text),
            Value::Bytes(bytes) => output.serialize_str(&to_base64(bytes)),
            Value::List(items) => {
                let mut list = output.serialize_seq(Some(items.len()))?;
                items.iter().try_for_each(|item| list.serialize_element(&Json(item)))?;
                list.end()
            }
            Value::Map(entries) => {
                let mut map = output.serialize_map(Some(entries.len()))?;
                entries.iter().try_for_each(|(key, value)| map.serialize_entry(&key_text(key), &Json(value)))?;
                map.end()
            }
            Value::Opaque(opaque) => Json(&opaque.fields()).serialize(output),
            Value::Written(written) => Json(&written.meaning).serialize(output),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_is_one_line_without_characters_that_a_terminal_acts_on() {
        let value = Value::fields([
            ("nan", f64::NAN.into()),
            ("infinite", f64::NEG_INFINITY.into()),
            ("speed", 1.84.into()),
            ("large", u64::MAX.into()),
            ("bytes", Value::Bytes(vec![1, 255])),
            ("text", "a\nb\u{1b}[31m\u{9b}\u{202e}ä".into()),
            ("map", Value::Map(vec![(Value::Int(7), Value::Null), (Value::Null, true.into())])),
        ]);
        let expected = concat!(
            r#"{"nan":"NaN","infinite":"-Infinity","speed":1.84,"large":18446744073709551615,"bytes":"Af8=","#,
            r#""text":"a\nb\u001b[31m\u009b\u202eä","map":{"7":null,"null":true}}"#,
        );
        assert_eq!(to_json(&value), expected);
    }
}
