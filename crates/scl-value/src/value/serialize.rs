//! How values are written in JSON, in YAML and in the codecs without a schema.

use super::{Value, key_text};
use crate::base64::to_base64;
use scl_terminal::escape_json;
use serde::ser::{Serialize, Serializer};
use serde_yaml::value::{Tag, TaggedValue};

/// The key of the number of a MessagePack extension.
pub(crate) const EXTENSION: &str = "@extension";
/// The key of the bytes of a MessagePack extension.
pub(crate) const DATA: &str = "data";
/// The name by which `rmp_serde` knows extensions.
const EXTENSION_STRUCT: &str = rmp_serde::MSGPACK_EXT_STRUCT_NAME;

/// A value as JSON on one line. Bytes are base64, NaN and infinities are texts, as in protobuf's JSON; keys are texts.
///
/// All characters that a terminal could act on are escaped.
pub fn to_json(value: &Value) -> String {
    // Writing to memory cannot fail, and every value has a JSON form.
    escape_json(&serde_json::to_string(&InFormat(value, Format::Json)).unwrap_or_default()).into_owned()
}

/// The format in which a value is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    Json,
    Yaml,
    /// CBOR and MessagePack, which have bytes and keys of all sorts.
    Binary,
}

/// A value that is serialized in a format.
pub(crate) struct InFormat<'v>(pub(crate) &'v Value, pub(crate) Format);

impl Serialize for InFormat<'_> {
    fn serialize<S: Serializer>(&self, output: S) -> Result<S::Ok, S::Error> {
        let Self(value, format) = *self;
        let part = |value| InFormat(value, format);
        match value {
            // Not `serialize_unit`, which CBOR writes as an empty list.
            Value::Null => output.serialize_none(),
            Value::Bool(flag) => output.serialize_bool(*flag),
            Value::Int(number) => output.serialize_i64(*number),
            Value::Uint(number) => output.serialize_u64(*number),
            Value::Float(number) => match *number {
                f64::INFINITY if format == Format::Json => output.serialize_str("Infinity"),
                f64::NEG_INFINITY if format == Format::Json => output.serialize_str("-Infinity"),
                number if number.is_nan() && format == Format::Json => output.serialize_str("NaN"),
                number => output.serialize_f64(number),
            },
            Value::Text(text) => output.serialize_str(text),
            Value::Bytes(bytes) => match format {
                Format::Json => output.serialize_str(&to_base64(bytes)),
                Format::Yaml => {
                    TaggedValue { tag: Tag::new("binary"), value: to_base64(bytes).into() }.serialize(output)
                }
                Format::Binary => output.serialize_bytes(bytes),
            },
            Value::List(items) => output.collect_seq(items.iter().map(part)),
            Value::Map(entries) => match (format, &entries[..]) {
                (Format::Json, _) => {
                    output.collect_map(entries.iter().map(|(key, value)| (key_text(key), part(value))))
                }
                (Format::Binary, [(name, Value::Int(number @ -128..=127)), (data, bytes @ Value::Bytes(_))])
                    if *name == EXTENSION.into() && *data == DATA.into() =>
                {
                    output.serialize_newtype_struct(EXTENSION_STRUCT, &(*number as i8, part(bytes)))
                }
                _ => output.collect_map(entries.iter().map(|(key, value)| (part(key), part(value)))),
            },
            Value::Opaque(opaque) => part(&opaque.fields()).serialize(output),
            Value::Written(written) => part(&written.meaning).serialize(output),
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
