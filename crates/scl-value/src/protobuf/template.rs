//! An example message with all fields of its type.

use super::well_known::{Short, short};
use crate::value::Value;
use prost_reflect::{FieldDescriptor, Kind, MessageDescriptor};

/// Maximum number of fields of an example, because nested types may have very many in total.
const MAX_FIELDS: usize = 1000;

/// An example of a message: defaults, one element of each list and map, the first field of each oneof.
pub(crate) fn template(message: &MessageDescriptor) -> Value {
    example(message, &mut vec![message.clone()], &mut 0)
}

fn example(message: &MessageDescriptor, around: &mut Vec<MessageDescriptor>, count: &mut usize) -> Value {
    match short(message) {
        Some(Short::Text) => match message.name() {
            "Timestamp" => "1970-01-01T00:00:00Z".into(),
            "Duration" => "0s".into(),
            _ => "".into(),
        },
        Some(Short::Wrapper) => message.get_field(1).map_or(Value::Null, |field| of_kind(&field.kind(), around, count)),
        Some(Short::Struct | Short::Any) => Value::Map(Vec::new()),
        Some(Short::Value) => Value::Null,
        Some(Short::List) => Value::List(Vec::new()),
        None => {
            let mut fields: Vec<FieldDescriptor> = message.fields().filter(is_first).collect();
            // Skip recursive fields, which would never end.
            fields.retain(|field| !around.iter().any(|outer| contains(field, outer)) && !is_any(field));
            let mut entries = Vec::new();
            for field in fields {
                *count += 1;
                if *count <= MAX_FIELDS {
                    entries.push((field.name().into(), of_field(&field, around, count)));
                }
            }
            Value::Map(entries)
        }
    }
}

/// Whether a field belongs to no oneof, or is the first field of its oneof.
fn is_first(field: &FieldDescriptor) -> bool {
    field.containing_oneof().is_none_or(|oneof| oneof.fields().next().as_ref() == Some(field))
}

/// Whether a field is an `Any`, which has no example because its JSON needs a type.
fn is_any(field: &FieldDescriptor) -> bool {
    field.kind().as_message().is_some_and(|message| short(message) == Some(Short::Any))
}

/// Whether a field holds messages of a type.
fn contains(field: &FieldDescriptor, message: &MessageDescriptor) -> bool {
    match field.kind() {
        Kind::Message(entry) if field.is_map() => {
            entry.map_entry_value_field().kind().as_message().is_some_and(|value| value == message)
        }
        kind => kind.as_message() == Some(message),
    }
}

fn of_field(field: &FieldDescriptor, around: &mut Vec<MessageDescriptor>, count: &mut usize) -> Value {
    match field.kind() {
        Kind::Message(entry) if field.is_map() => {
            let key = of_kind(&entry.map_entry_key_field().kind(), around, count);
            let value = of_kind(&entry.map_entry_value_field().kind(), around, count);
            Value::Map(vec![(key, value)])
        }
        kind if field.is_list() => Value::List(vec![of_kind(&kind, around, count)]),
        kind => of_kind(&kind, around, count),
    }
}

fn of_kind(kind: &Kind, around: &mut Vec<MessageDescriptor>, count: &mut usize) -> Value {
    match kind {
        Kind::Message(message) => {
            around.push(message.clone());
            let value = example(message, around, count);
            around.pop();
            value
        }
        Kind::Enum(descriptor) => descriptor.default_value().name().into(),
        Kind::String => "".into(),
        Kind::Bytes => Value::Bytes(Vec::new()),
        Kind::Bool => false.into(),
        Kind::Double | Kind::Float => 0.0.into(),
        _ => Value::Int(0),
    }
}
