//! Encodes dynamic messages without losing -0.0, which prost takes for the default of a field and leaves out.
//!
//! Protobuf leaves out only what has the bits of 0.0 (<https://protobuf.dev/programming-guides/proto3/#default>).

use prost::Message;
use prost::encoding::{WireType, encode_key, encode_varint};
use prost_reflect::{DynamicMessage, FieldDescriptor, MapKey, ReflectMessage, Value};

/// Encodes a message.
pub fn encode(message: &DynamicMessage) -> Vec<u8> {
    if !loses_sign(message) {
        return message.encode_to_vec();
    }
    let mut bytes = Vec::new();
    for field in message.descriptor().fields() {
        let value = message.get_field(&field);
        if is_left_out(&field, &value) {
            encode_negative_zero(&field, &value, &mut bytes);
        } else if message.has_field(&field) {
            encode_field(message, &field, &value, &mut bytes);
        }
    }
    bytes
}

/// Returns true if prost would leave out a -0.0 of this message or of one inside.
pub fn loses_sign(message: &DynamicMessage) -> bool {
    message.descriptor().fields().any(|field| {
        let value = message.get_field(&field);
        is_left_out(&field, &value) || message.has_field(&field) && contains_loss(&value)
    })
}

fn contains_loss(value: &Value) -> bool {
    match value {
        Value::Message(message) => loses_sign(message),
        Value::List(items) => items.iter().any(contains_loss),
        Value::Map(entries) => entries.values().any(|value| is_negative_zero(value) || contains_loss(value)),
        _ => false,
    }
}

fn is_left_out(field: &FieldDescriptor, value: &Value) -> bool {
    !field.supports_presence() && is_negative_zero(value)
}

fn is_negative_zero(value: &Value) -> bool {
    match value {
        Value::F32(number) => *number == 0.0 && number.is_sign_negative(),
        Value::F64(number) => *number == 0.0 && number.is_sign_negative(),
        _ => false,
    }
}

fn encode_negative_zero(field: &FieldDescriptor, value: &Value, bytes: &mut Vec<u8>) {
    if matches!(value, Value::F32(_)) {
        encode_key(field.number(), WireType::ThirtyTwoBit, bytes);
        bytes.extend_from_slice(&(-0.0_f32).to_le_bytes());
    } else {
        encode_key(field.number(), WireType::SixtyFourBit, bytes);
        bytes.extend_from_slice(&(-0.0_f64).to_le_bytes());
    }
}

fn encode_field(message: &DynamicMessage, field: &FieldDescriptor, value: &Value, bytes: &mut Vec<u8>) {
    match value {
        Value::Message(inner) if contains_loss(value) && !field.is_group() => encode_inner(field, inner, bytes),
        Value::List(items) if contains_loss(value) && !field.is_group() => {
            items.iter().filter_map(Value::as_message).for_each(|inner| encode_inner(field, inner, bytes));
        }
        Value::Map(entries) if contains_loss(value) => {
            let kind = field.kind();
            let Some(entry) = kind.as_message() else { return };
            for (key, value) in entries {
                let mut inner = DynamicMessage::new(entry.clone());
                inner.set_field(&entry.map_entry_key_field(), value_of(key));
                inner.set_field(&entry.map_entry_value_field(), value.clone());
                encode_inner(field, &inner, bytes);
            }
        }
        value => {
            let mut alone = DynamicMessage::new(message.descriptor());
            alone.set_field(field, value.clone());
            bytes.extend(alone.encode_to_vec());
        }
    }
}

fn encode_inner(field: &FieldDescriptor, inner: &DynamicMessage, bytes: &mut Vec<u8>) {
    let content = encode(inner);
    encode_key(field.number(), WireType::LengthDelimited, bytes);
    encode_varint(content.len() as u64, bytes);
    bytes.extend(content);
}

fn value_of(key: &MapKey) -> Value {
    match key.clone() {
        MapKey::Bool(flag) => Value::Bool(flag),
        MapKey::I32(number) => Value::I32(number),
        MapKey::I64(number) => Value::I64(number),
        MapKey::U32(number) => Value::U32(number),
        MapKey::U64(number) => Value::U64(number),
        MapKey::String(text) => Value::String(text),
    }
}
