//! From decoded messages of protobuf to values.

mod short_form;

use super::UNKNOWN;
use crate::limits::MAX_DEPTH;
use crate::value::{Value, widen};
use prost::bytes::Buf;
use prost::encoding::{WireType, decode_key, decode_varint};
use prost_reflect::{DynamicMessage, FieldDescriptor, Kind, MapKey, ReflectMessage as _, UnknownField};

/// The value of a message; `depth` counts the messages around it.
pub(super) fn to_value(message: &DynamicMessage, depth: usize) -> Value {
    short_form::shorten(message, depth).unwrap_or_else(|| plain(message, depth))
}

/// The fields of a message, whether it is a well-known one or not.
fn plain(message: &DynamicMessage, depth: usize) -> Value {
    if depth >= MAX_DEPTH {
        // The decoder's own limit is lower, but every nested `Any` is decoded separately.
        return Value::Null;
    }
    let descriptor = message.descriptor();
    let is_shown = |field: &FieldDescriptor| !field.supports_presence() || message.has_field(field);
    let fields = descriptor
        .fields()
        .filter(is_shown)
        .map(|field| (field.name().into(), field_value(&field.kind(), &message.get_field(&field), depth)));
    let extensions = message.extensions().map(|(extension, value)| {
        (Value::Text(format!("[{}]", extension.full_name())), field_value(&extension.kind(), value, depth))
    });
    let mut entries: Vec<_> = fields.chain(extensions).collect();
    let unknown: Vec<_> = message.unknown_fields().map(unknown_field).collect();
    if !unknown.is_empty() {
        entries.push((UNKNOWN.into(), Value::Map(unknown)));
    }
    Value::Map(entries)
}

fn field_value(kind: &Kind, value: &prost_reflect::Value, depth: usize) -> Value {
    use prost_reflect::Value as V;
    match value {
        V::Bool(flag) => Value::Bool(*flag),
        V::I32(number) => Value::Int((*number).into()),
        V::I64(number) => Value::Int(*number),
        V::U32(number) => Value::Int((*number).into()),
        V::U64(number) => (*number).into(),
        V::F32(number) => Value::Float(widen(*number)),
        V::F64(number) => Value::Float(*number),
        V::String(text) => text.as_str().into(),
        V::Bytes(bytes) => Value::Bytes(bytes.to_vec()),
        V::EnumNumber(number) => {
            let known = kind.as_enum().and_then(|descriptor| descriptor.get_value(*number));
            known.map_or(Value::Int((*number).into()), |value| value.name().into())
        }
        V::Message(message) => to_value(message, depth + 1),
        V::List(items) => Value::List(items.iter().map(|item| field_value(kind, item, depth)).collect()),
        V::Map(entries) => {
            let kind = kind.as_message().map(|entry| entry.map_entry_value_field().kind());
            let kind = kind.unwrap_or(Kind::Bool);
            let mut sorted: Vec<_> = entries.iter().collect();
            sorted.sort_by(|(a, _), (b, _)| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
            Value::Map(
                sorted.into_iter().map(|(key, value)| (map_key(key), field_value(&kind, value, depth))).collect(),
            )
        }
    }
}

fn map_key(key: &MapKey) -> Value {
    match key {
        MapKey::Bool(flag) => Value::Bool(*flag),
        MapKey::I32(number) => Value::Int((*number).into()),
        MapKey::I64(number) => Value::Int(*number),
        MapKey::U32(number) => Value::Int((*number).into()),
        MapKey::U64(number) => (*number).into(),
        MapKey::String(text) => text.as_str().into(),
    }
}

/// A field that the type does not have: its number, and its content as far as it can be decoded without a type.
fn unknown_field(field: &UnknownField) -> (Value, Value) {
    let mut bytes = Vec::new();
    field.encode(&mut bytes);
    let mut rest = bytes.as_slice();
    let number = Value::Int(field.number().into());
    let Ok((_, wire)) = decode_key(&mut rest) else { return (number, Value::Null) };
    let content = match wire {
        WireType::Varint => decode_varint(&mut rest).map_or(Value::Null, Value::from),
        WireType::SixtyFourBit => rest.try_get_u64_le().map_or(Value::Null, Value::from),
        WireType::ThirtyTwoBit => rest.try_get_u32_le().map_or(Value::Null, |number| Value::Int(number.into())),
        WireType::LengthDelimited => match decode_varint(&mut rest) {
            Ok(_) => Value::Bytes(rest.to_vec()),
            Err(_) => Value::Null,
        },
        WireType::StartGroup | WireType::EndGroup => Value::Bytes(rest.to_vec()),
    };
    (number, content)
}
