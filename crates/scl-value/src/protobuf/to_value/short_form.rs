//! Well-known messages as values in their short form.

use super::super::check;
use super::super::well_known::{Short, TYPE, any_type, short};
use super::{plain, to_value};
use crate::limits::MAX_DEPTH;
use crate::value::Value;
use prost_reflect::{DynamicMessage, ReflectMessage as _};

/// A well-known message in its short form; `None` if it has none, or if this message cannot be expressed in it.
pub(super) fn shorten(message: &DynamicMessage, depth: usize) -> Option<Value> {
    // Keep unknown fields, which the short form would lose.
    if message.unknown_fields().next().is_some() {
        return None;
    }
    let inner = |name| match plain(message, depth) {
        Value::Map(entries) => entries.into_iter().find(|(key, _)| *key == Value::from(name)).map(|(_, value)| value),
        _ => None,
    };
    match short(&message.descriptor())? {
        Short::Text => match serde_json::to_value(message).ok()? {
            serde_json::Value::String(text) => Some(text.into()),
            _ => None,
        },
        Short::Wrapper => inner("value"),
        Short::Struct => inner("fields"),
        Short::List => inner("values"),
        Short::Value => match plain(message, depth) {
            // The message is a oneof, so it has one field; `null_value` is an enum.
            Value::Map(mut entries) => match entries.pop()? {
                (name, _) if name == "null_value".into() => Some(Value::Null),
                (_, value) => Some(value),
            },
            _ => None,
        },
        Short::Any => any(message, depth),
    }
}

/// The fields of the message in an `Any`, if the schema describes it.
fn any(message: &DynamicMessage, depth: usize) -> Option<Value> {
    let url = message.get_field_by_name("type_url")?.as_str()?.to_owned();
    let bytes = message.get_field_by_name("value")?.as_bytes()?.clone();
    let descriptor = any_type(&message.descriptor(), &url)?;
    // The decoder's limits start anew in each `Any`, so the depth is limited here.
    if depth + 1 >= MAX_DEPTH || check::check(&descriptor, &bytes).is_err() {
        return None;
    }
    let content = DynamicMessage::decode(descriptor.clone(), bytes).ok()?;
    let mut entries = vec![(TYPE.into(), url.into())];
    match to_value(&content, depth + 1) {
        Value::Map(fields) if short(&descriptor).is_none() => entries.extend(fields),
        value => entries.push(("value".into(), value)),
    }
    Some(Value::Map(entries))
}
