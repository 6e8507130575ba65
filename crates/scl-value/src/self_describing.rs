//! JSON, CBOR and MessagePack without a type: these formats are self-describing.

use crate::base64::from_base64;
use crate::error::Mismatch;
use crate::limits::{Budget, Exceeded, MAX_DEPTH};
use crate::value::{DATA, EXTENSION, Format, InFormat, Value, widen};
use bytes::Bytes;
use cbor4ii::core::dec::Read;
use cbor4ii::core::utils::{BufWriter, SliceReader};
use serde::de::{DeserializeSeed, EnumAccess, Error, MapAccess, SeqAccess, VariantAccess, Visitor};
use serde::ser::Serialize;
use std::fmt;

/// Reads one value from any deserializer, within the limits.
pub(crate) struct AnyValue<'b> {
    budget: &'b Budget,
    depth: usize,
}

impl<'b> AnyValue<'b> {
    pub(crate) fn new(budget: &'b Budget) -> Self {
        Self { budget, depth: 0 }
    }

    fn below(&self) -> Result<Self, Exceeded> {
        if self.depth == MAX_DEPTH { Err(Exceeded::Depth) } else { Ok(Self { depth: self.depth + 1, ..*self }) }
    }
}

/// What is wrong with a payload, and after how many bytes, if that is known.
pub(crate) type Wrong = (String, Option<usize>);

/// Reads JSON without a type.
pub(crate) fn read_json(bytes: &[u8]) -> Result<Value, Wrong> {
    let mut input = serde_json::Deserializer::from_slice(bytes);
    let value = AnyValue::new(&Budget::new()).deserialize(&mut input).and_then(|value| input.end().map(|()| value));
    // The error text already names line and column.
    value.map_err(|error| (error.to_string(), None))
}

/// Reads one CBOR item; tags are left out.
pub(crate) fn read_cbor(bytes: &[u8]) -> Result<Value, Wrong> {
    match scl_cbor::simplify(bytes) {
        // Offsets in the simplified item are not offsets in the frame.
        Some(simple) => read_simple_cbor(&simple).map_err(|(reason, _)| (reason, None)),
        None => read_simple_cbor(bytes),
    }
}

fn read_simple_cbor(bytes: &[u8]) -> Result<Value, Wrong> {
    let mut input = cbor4ii::serde::Deserializer::new(SliceReader::new(bytes));
    let read = AnyValue::new(&Budget::new()).deserialize(&mut input);
    let rest = input.into_inner().fill(usize::MAX).map_or(0, |rest| rest.as_ref().len());
    let offset = Some(bytes.len() - rest);
    match read {
        Ok(value) if rest == 0 => Ok(value),
        Ok(_) => Err(("data follows the item".to_owned(), offset)),
        Err(error) => Err((cbor_reason(&error), offset)),
    }
}

/// Describes an error, because the library's own text is that of `Debug`.
fn cbor_reason<E>(error: &cbor4ii::serde::DecodeError<E>) -> String {
    use cbor4ii::core::dec::Error as Core;
    use cbor4ii::serde::DecodeError;
    match error {
        DecodeError::Custom(reason) => return reason.to_string(),
        DecodeError::Core(Core::Eof { .. }) => "the item is truncated",
        DecodeError::Core(Core::Unsupported { .. }) => "simple values are not supported",
        DecodeError::Core(Core::RequireUtf8 { .. }) => "the text is not valid UTF-8",
        DecodeError::Core(Core::DepthOverflow { .. }) => "it is nested too deep",
        DecodeError::Core(_) => "the item is malformed",
    }
    .to_owned()
}

/// Reads one MessagePack value.
pub(crate) fn read_msgpack(bytes: &[u8]) -> Result<Value, Wrong> {
    let mut rest = std::io::Cursor::new(bytes);
    let read = AnyValue::new(&Budget::new()).deserialize(&mut rmp_serde::Deserializer::new(&mut rest));
    let offset = usize::try_from(rest.position()).ok();
    match read {
        Ok(value) if offset == Some(bytes.len()) => Ok(value),
        Ok(_) => Err(("data follows the value".to_owned(), offset)),
        Err(error) => Err((error.to_string(), offset)),
    }
}

/// Writes one CBOR item.
pub(crate) fn write_cbor(value: &Value) -> Result<Bytes, Mismatch> {
    let mut writer = BufWriter::new(Vec::new());
    let wrong = |error: cbor4ii::serde::EncodeError<_>| Mismatch::new(error.to_string());
    InFormat(value, Format::Binary).serialize(&mut cbor4ii::serde::Serializer::new(&mut writer)).map_err(wrong)?;
    Ok(writer.into_inner().into())
}

/// Writes one MessagePack value.
pub(crate) fn write_msgpack(value: &Value) -> Result<Bytes, Mismatch> {
    let mut bytes = Vec::new();
    let mut output = rmp_serde::Serializer::new(&mut bytes);
    InFormat(value, Format::Binary).serialize(&mut output).map_err(|error| Mismatch::new(error.to_string()))?;
    Ok(bytes.into())
}

impl<'de> DeserializeSeed<'de> for AnyValue<'_> {
    type Value = Value;

    fn deserialize<D: serde::Deserializer<'de>>(self, input: D) -> Result<Value, D::Error> {
        self.budget.take(1).map_err(D::Error::custom)?;
        input.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for AnyValue<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_bool<E>(self, flag: bool) -> Result<Value, E> {
        Ok(Value::Bool(flag))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Value, E> {
        Ok(Value::Int(number))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Value, E> {
        Ok(number.into())
    }

    // CBOR and YAML allow integers of more than 64 bits; they are rounded to floats.
    fn visit_i128<E>(self, number: i128) -> Result<Value, E> {
        Ok(i64::try_from(number).map_or(Value::Float(number as f64), Value::Int))
    }

    fn visit_u128<E>(self, number: u128) -> Result<Value, E> {
        Ok(u64::try_from(number).map_or(Value::Float(number as f64), Value::from))
    }

    fn visit_f32<E>(self, number: f32) -> Result<Value, E> {
        Ok(Value::Float(widen(number)))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Value, E> {
        Ok(Value::Float(number))
    }

    fn visit_str<E>(self, text: &str) -> Result<Value, E> {
        Ok(text.into())
    }

    fn visit_bytes<E>(self, bytes: &[u8]) -> Result<Value, E> {
        Ok(Value::Bytes(bytes.to_owned()))
    }

    fn visit_none<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_some<D: serde::Deserializer<'de>>(self, input: D) -> Result<Value, D::Error> {
        self.deserialize(input)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = items.next_element_seed(self.below().map_err(A::Error::custom)?)? {
            list.push(item);
        }
        Ok(Value::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut map = Vec::new();
        while let Some(key) = entries.next_key_seed(self.below().map_err(A::Error::custom)?)? {
            map.push((key, entries.next_value_seed(self.below().map_err(A::Error::custom)?)?));
        }
        Ok(Value::Map(map))
    }

    /// An extension of MessagePack: a number and bytes.
    fn visit_newtype_struct<D: serde::Deserializer<'de>>(self, input: D) -> Result<Value, D::Error> {
        match AnyValue::new(self.budget).deserialize(input)? {
            Value::List(parts) => match <[Value; 2]>::try_from(parts) {
                Ok([number, data]) => Ok(Value::fields([(EXTENSION, number), (DATA, data)])),
                Err(parts) => Ok(Value::List(parts)),
            },
            other => Ok(other),
        }
    }

    /// A tagged value of YAML: `!binary` is bytes in base64, any other tag is left out.
    fn visit_enum<A: EnumAccess<'de>>(self, tagged: A) -> Result<Value, A::Error> {
        let below = self.below().map_err(A::Error::custom)?;
        let (tag, content) = tagged.variant::<String>()?;
        match (tag.trim_start_matches('!'), content.newtype_variant_seed(below)?) {
            ("binary", Value::Text(text)) => from_base64(&text).map(Value::Bytes).map_err(A::Error::custom),
            (_, value) => Ok(value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tags and floats of 16 bits, as cbor2 writes them with `canonical=True`.
    #[test]
    fn cbor_of_other_encoders_is_read() {
        let read = read_cbor(b"\xd9\xd9\xf7\xa2ax\xf9\x3e\0at\xc1\x1a\0\0\0\x07").unwrap();
        assert_eq!(read, Value::fields([("x", Value::Float(1.5)), ("t", Value::Int(7))]));
        assert_eq!(read_cbor(b"\xc1\x82\x01"), Err(("the item is truncated".to_owned(), None)));
    }
}
