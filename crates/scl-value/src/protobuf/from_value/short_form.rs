//! Well-known messages from values in their short form.

use super::super::well_known::{Short, TYPE, any_type, short};
use super::{Unknown, from_value};
use crate::error::Mismatch;
use crate::value::{Value, key_text};
use prost::Message;
use prost_reflect::{DynamicMessage, MapKey, MessageDescriptor, Value as Field};
use std::collections::HashMap;

/// Reads the short form of a well-known message; `None` if it has none, or if the value is its plain form.
pub(super) fn lengthen(
    message: &MessageDescriptor,
    value: &Value,
    unknown: &mut Unknown,
) -> Option<Result<DynamicMessage, Mismatch>> {
    let is_plain = |name: &str| matches!(value, Value::Map(_)) && value.get(name).is_some();
    let wrapped = |name: &str, value: &Value, unknown: &mut Unknown| {
        from_value(message, &Value::fields([(name, value.clone())]), unknown).map_err(|error| Mismatch {
            path: error.path.strip_prefix(name).unwrap_or(&error.path).trim_start_matches('.').to_owned(),
            ..error
        })
    };
    Some(match short(message)? {
        Short::Text => match value.meaning() {
            Value::Text(text) => {
                let text = serde_json::Value::String(text.clone());
                DynamicMessage::deserialize(message.clone(), text)
                    .map_err(|error| Mismatch::new(format!("{error}; expected {}", expected(message))))
            }
            Value::Map(_) => return None,
            other => Err(Mismatch::new(format!("expected {}, found {}", expected(message), other.kind()))),
        },
        Short::Wrapper if is_plain("value") => return None,
        Short::Wrapper => wrapped("value", value, unknown),
        Short::Struct | Short::Value | Short::List => anything(message, value),
        Short::Any => {
            let url = match value.get(TYPE)? {
                Value::Text(url) => url.clone(),
                other => {
                    return Some(Err(Mismatch::new(format!("expected a text, found {}", other.kind())).below(TYPE)));
                }
            };
            let Some(descriptor) = any_type(message, &url) else {
                return Some(Err(Mismatch::new(format!("the schema has no message `{url}`")).below(TYPE)));
            };
            let content = match value {
                Value::Map(_) if short(&descriptor).is_some() => value.get("value").cloned().unwrap_or(Value::Null),
                Value::Map(entries) => {
                    Value::Map(entries.iter().filter(|(key, _)| *key != TYPE.into()).cloned().collect())
                }
                _ => Value::Null,
            };
            from_value(&descriptor, &content, unknown).map(|content| {
                let mut any = DynamicMessage::new(message.clone());
                any.set_field_by_name("type_url", Field::String(url));
                any.set_field_by_name("value", Field::Bytes(content.encode_to_vec().into()));
                any
            })
        }
    })
}

/// What the text of a well-known message looks like.
fn expected(message: &MessageDescriptor) -> &'static str {
    match message.name() {
        "Timestamp" => "a time like `2026-11-22T10:00:00.5Z`",
        "Duration" => "a duration like `1.5s`",
        _ => "field names like `speed,unit`",
    }
}

/// Builds a `Struct`, `ListValue` or `Value` from any value.
fn anything(message: &MessageDescriptor, value: &Value) -> Result<DynamicMessage, Mismatch> {
    let nested = |name: &str, value: &Value| {
        let inner = message.parent_pool().get_message_by_name(&format!("google.protobuf.{name}"));
        let inner = inner.ok_or_else(|| Mismatch::new(format!("the schema has no `google.protobuf.{name}`")))?;
        anything(&inner, value).map(Field::Message)
    };
    let mut result = DynamicMessage::new(message.clone());
    let (name, field) = match (message.name(), value) {
        ("Struct", Value::Map(entries)) => {
            let entry = |(key, value): &(Value, Value)| Ok((MapKey::String(key_text(key)), nested("Value", value)?));
            let map: HashMap<_, _> = entries.iter().map(entry).collect::<Result<_, Mismatch>>()?;
            ("fields", Field::Map(map))
        }
        ("ListValue", Value::List(items)) => {
            let items: Vec<_> = items.iter().map(|item| nested("Value", item)).collect::<Result<_, _>>()?;
            ("values", Field::List(items))
        }
        ("Value", value) => match value.meaning() {
            Value::Null => ("null_value", Field::EnumNumber(0)),
            Value::Bool(flag) => ("bool_value", Field::Bool(*flag)),
            Value::Int(number) => ("number_value", Field::F64(*number as f64)),
            Value::Uint(number) => ("number_value", Field::F64(*number as f64)),
            Value::Float(number) => ("number_value", Field::F64(*number)),
            Value::Text(text) => ("string_value", Field::String(text.clone())),
            Value::List(_) => ("list_value", nested("ListValue", value)?),
            Value::Map(_) => ("struct_value", nested("Struct", value)?),
            Value::Bytes(_) | Value::Opaque(_) | Value::Written(_) => {
                return Err(Mismatch::new(format!("expected a value as in JSON, found {}", value.kind())));
            }
        },
        ("Struct", other) => return Err(Mismatch::new(format!("expected a map, found {}", other.kind()))),
        (_, other) => return Err(Mismatch::new(format!("expected a list, found {}", other.kind()))),
    };
    result.set_field_by_name(name, field);
    Ok(result)
}
