//! From values to messages of protobuf, with errors that name the field.

mod number;
mod short_form;

use super::UNKNOWN;
use crate::base64::{from_base64, to_base64};
use crate::error::Mismatch;
use crate::text::from_hex;
use crate::value::{Value, key_text};
use number::{float, integer};
use prost_reflect::{DynamicMessage, EnumDescriptor, FieldDescriptor, Kind, MapKey, MessageDescriptor, Value as Field};
use scl_terminal::quoted_list;
use std::collections::HashMap;

/// Maximum number of names that an error lists.
const LISTED: usize = 20;

/// What happens to fields that the type does not have.
pub(crate) enum Unknown {
    /// An error: a user has written them.
    Refuse,
    /// Their names are collected: a newer program may have sent them.
    Collect(Vec<String>),
}

/// The message that a value describes.
pub(crate) fn from_value(
    message: &MessageDescriptor,
    value: &Value,
    unknown: &mut Unknown,
) -> Result<DynamicMessage, Mismatch> {
    if let Some(read) = short_form::lengthen(message, value, unknown) {
        return read;
    }
    let Value::Map(entries) = value else {
        return Err(wrong(&format!("the fields of `{}`", message.full_name()), value).note(known_fields(message)));
    };
    let mut result = DynamicMessage::new(message.clone());
    let mut given: Vec<FieldDescriptor> = Vec::new();
    for (key, value) in entries {
        let name = key_text(key);
        if name == UNKNOWN {
            continue;
        }
        // The key is the field's name in the `.proto` file or in JSON.
        let named = message.get_field_by_name(&name).or_else(|| message.get_field_by_json_name(&name));
        let Some(field) = named else {
            match unknown {
                Unknown::Refuse => return Err(unknown_field(message, &name)),
                Unknown::Collect(names) => names.push(name),
            }
            continue;
        };
        check_given(&field, &given)?;
        let is_null = *value.meaning() == Value::Null && !takes_null(&field.kind(), value);
        if !is_null {
            let read = read_field(&field, value, unknown).map_err(|error| error.below(&name))?;
            result.set_field(&field, read);
            given.push(field);
        }
    }
    let is_missing = |field: &FieldDescriptor| field.is_required() && !given.contains(field);
    match message.fields().find(is_missing) {
        Some(field) => Err(Mismatch::new(format!("the required field `{}` is missing", field.name()))),
        None => Ok(result),
    }
}

/// Lists the fields of a message: `its fields: ...`
fn known_fields(message: &MessageDescriptor) -> String {
    let names: Vec<String> = message.fields().map(|field| field.name().to_owned()).collect();
    match names.len() {
        0 => "it has no fields".to_owned(),
        1..=LISTED => format!("its fields: {}", quoted_list(&names)),
        count => {
            let first = quoted_list(names.iter().take(LISTED).map(String::as_str));
            format!("its fields: {first} and {} more", count - LISTED)
        }
    }
}

pub(super) fn unknown_field(message: &MessageDescriptor, name: &str) -> Mismatch {
    let error = Mismatch::new(format!("message `{}` has no field `{name}`", message.full_name()));
    let names: Vec<String> = message.fields().map(|field| field.name().to_owned()).collect();
    error.did_you_mean(name, names.iter().map(String::as_str)).note(known_fields(message))
}

/// Checks that a field is given only once, and only one field of a oneof.
fn check_given(field: &FieldDescriptor, given: &[FieldDescriptor]) -> Result<(), Mismatch> {
    if given.contains(field) {
        return Err(Mismatch::new(format!("the field `{}` is given twice", field.name())));
    }
    let Some(oneof) = field.containing_oneof() else { return Ok(()) };
    match given.iter().find(|other| other.containing_oneof().as_ref() == Some(&oneof)) {
        None => Ok(()),
        Some(other) => {
            let (first, second) = (other.name(), field.name());
            let reason = format!("the fields `{first}` and `{second}` exclude each other");
            Err(Mismatch::new(reason).note(format!("they belong to the oneof `{}`", oneof.name())))
        }
    }
}

/// Whether null is a value of this kind, rather than a missing one.
fn takes_null(kind: &Kind, null: &Value) -> bool {
    let is_any = kind.as_message().is_some_and(|message| message.full_name() == "google.protobuf.Value");
    let is_named = || kind.as_enum().is_some_and(|names| names.get_value_by_name(&key_text(null)).is_some());
    is_any || is_named()
}

fn read_field(field: &FieldDescriptor, value: &Value, unknown: &mut Unknown) -> Result<Field, Mismatch> {
    let kind = field.kind();
    if field.is_map() {
        let (Value::Map(entries), Kind::Message(entry)) = (value, &kind) else {
            return Err(wrong("a map", value));
        };
        let (key_kind, value_kind) = (entry.map_entry_key_field().kind(), entry.map_entry_value_field().kind());
        let mut map = HashMap::new();
        for (key, value) in entries {
            let name = format!("[{}]", key_text(key));
            let key = map_key(&key_kind, key).map_err(|error| error.below(&name))?;
            let value = read_value(&value_kind, value, unknown).map_err(|error| error.below(&name))?;
            if map.insert(key, value).is_some() {
                return Err(Mismatch::new("the key is given twice").below(&name));
            }
        }
        return Ok(Field::Map(map));
    }
    if field.is_list() {
        let Value::List(items) = value else {
            let hint = format!("write `{}: [...]`", field.name());
            return Err(wrong("a list", value).help(hint));
        };
        let read = |(index, item)| read_value(&kind, item, unknown).map_err(|error| error.below(&format!("[{index}]")));
        return Ok(Field::List(items.iter().enumerate().map(read).collect::<Result<_, _>>()?));
    }
    read_value(&kind, value, unknown)
}

fn read_value(kind: &Kind, value: &Value, unknown: &mut Unknown) -> Result<Field, Mismatch> {
    Ok(match kind {
        Kind::Message(message) => Field::Message(from_value(message, value, unknown)?),
        Kind::Enum(descriptor) => Field::EnumNumber(enum_number(descriptor, value)?),
        Kind::Bool => match value.meaning() {
            Value::Bool(flag) => Field::Bool(*flag),
            Value::Text(word) => return Err(boolean_word(word, wrong("true or false", value))),
            _ => return Err(wrong("true or false", value)),
        },
        Kind::String => match value.meaning() {
            Value::Text(text) => Field::String(text.clone()),
            _ => return Err(unquoted(value, wrong("a text", value))),
        },
        Kind::Bytes => match value.meaning() {
            Value::Bytes(bytes) => Field::Bytes(bytes.clone().into()),
            Value::Text(text) => {
                let decoded = from_base64(text).map_err(|reason| {
                    Mismatch::new(format!("expected bytes as base64: {}", reason.trim_end_matches('.')))
                })?;
                Field::Bytes(decoded.into())
            }
            _ => {
                let error = wrong("bytes as base64", value);
                let in_hex = Some(key_text(value)).filter(|text| text.starts_with("0x")).and_then(|hex| from_hex(&hex));
                return Err(match in_hex {
                    Some(bytes) => error.help(format!("as base64, these bytes are '{}'", to_base64(&bytes))),
                    None => unquoted(value, error),
                });
            }
        },
        Kind::Double => Field::F64(float(value, "double")?),
        Kind::Float => {
            let number = float(value, "float")?;
            let narrow = number as f32;
            if number.is_finite() && narrow.is_infinite() {
                return Err(Mismatch::new(format!("{number:e} is too large for a number of 32 bits (float)")));
            }
            Field::F32(narrow)
        }
        Kind::Int32 | Kind::Sint32 | Kind::Sfixed32 => Field::I32(integer(value, "int32", i32::MIN, i32::MAX)?),
        Kind::Int64 | Kind::Sint64 | Kind::Sfixed64 => Field::I64(integer(value, "int64", i64::MIN, i64::MAX)?),
        Kind::Uint32 | Kind::Fixed32 => Field::U32(integer(value, "uint32", u32::MIN, u32::MAX)?),
        Kind::Uint64 | Kind::Fixed64 => Field::U64(integer(value, "uint64", u64::MIN, u64::MAX)?),
    })
}

fn wrong(expected: &str, found: &Value) -> Mismatch {
    Mismatch::new(format!("expected {expected}, found {}", told(found)))
}

/// Describes a value in an error: a short one by itself, others by their kind.
fn told(value: &Value) -> String {
    const LONGEST: usize = 40;
    match value.meaning() {
        Value::Text(text) if text.chars().count() <= LONGEST => format!("the text `{text}`"),
        Value::Bool(_) | Value::Int(_) | Value::Uint(_) | Value::Float(_) => key_text(value),
        other => other.kind().to_owned(),
    }
}

/// Adds to an error the hint to quote a scalar where a text is expected.
fn unquoted(value: &Value, error: Mismatch) -> Mismatch {
    match value.meaning() {
        Value::Int(_) | Value::Uint(_) | Value::Float(_) | Value::Bool(_) => {
            error.help(format!("quote it: '{}'", key_text(value)))
        }
        _ => error,
    }
}

/// Adds to an error the hint to write `true` or `false` where a text such as `yes` was found.
fn boolean_word(word: &str, error: Mismatch) -> Mismatch {
    match word.to_ascii_lowercase().as_str() {
        "yes" | "y" | "on" => error.help("write `true`"),
        "no" | "n" | "off" => error.help("write `false`"),
        _ => error,
    }
}

fn enum_number(descriptor: &EnumDescriptor, value: &Value) -> Result<i32, Mismatch> {
    // The name of an enum value may be a YAML keyword: `NULL`, `TRUE`.
    let name = key_text(value);
    if let Some(named) = descriptor.get_value_by_name(&name) {
        return Ok(named.number());
    }
    match value.meaning() {
        Value::Text(_) => {
            let names: Vec<String> = descriptor.values().map(|value| value.name().to_owned()).collect();
            let error = Mismatch::new(format!("`{}` has no value `{name}`", descriptor.full_name()));
            let error = error.did_you_mean(&name, names.iter().map(String::as_str));
            let listed = quoted_list(names.iter().take(LISTED).map(String::as_str));
            Err(error.note(format!("its values: {listed}{}", if names.len() > LISTED { ", ..." } else { "" })))
        }
        Value::Int(_) | Value::Uint(_) | Value::Float(_) => integer(value, "int32", i32::MIN, i32::MAX),
        _ => Err(wrong(&format!("a value of `{}`", descriptor.full_name()), value)),
    }
}

/// Reads the key of a map. In JSON, keys are texts, whatever their type.
fn map_key(kind: &Kind, key: &Value) -> Result<MapKey, Mismatch> {
    let flag = match key.meaning() {
        Value::Bool(flag) => Some(*flag),
        Value::Text(text) => text.parse().ok(),
        _ => None,
    };
    match (kind, flag) {
        (Kind::String, _) => Ok(MapKey::String(key_text(key))),
        (Kind::Bool, Some(flag)) => Ok(MapKey::Bool(flag)),
        (Kind::Bool, None) => Err(wrong("true or false", key)),
        _ => match read_value(kind, key, &mut Unknown::Refuse)? {
            Field::I32(number) => Ok(MapKey::I32(number)),
            Field::I64(number) => Ok(MapKey::I64(number)),
            Field::U32(number) => Ok(MapKey::U32(number)),
            Field::U64(number) => Ok(MapKey::U64(number)),
            _ => Err(wrong("a key", key)),
        },
    }
}
