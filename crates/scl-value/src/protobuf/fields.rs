//! The fields that a message of a type may have.

use super::from_value::unknown_field;
use super::well_known::{Short, short};
use crate::error::Mismatch;
use crate::field_kind::FieldKind;
use crate::path::{FieldPath, Segment};
use prost_reflect::{FieldDescriptor, Kind, MessageDescriptor};

/// Maximum number of columns of a table.
const MAX_COLUMNS: usize = 1000;

/// Returns what kind of value is at a path.
///
/// # Errors
/// The message has no such field.
pub(crate) fn kind_of(message: &MessageDescriptor, path: &FieldPath) -> Result<FieldKind, Mismatch> {
    let mut reached = of_message(message);
    for (index, segment) in path.segments().iter().enumerate() {
        reached = match (reached, segment) {
            (FieldKind::Unknown, _) => return Ok(FieldKind::Unknown),
            (FieldKind::Message(message), Segment::Name(name)) => match message.get_field_by_name(name) {
                Some(field) => of_field(&field),
                None if name.starts_with('@') => return Ok(FieldKind::Unknown),
                None => return Err(unknown_field(&message, name)),
            },
            (FieldKind::List(item), Segment::Index(_)) => *item,
            (FieldKind::Map(_, value), _) => *value,
            (FieldKind::Message(message), Segment::Index(_)) => {
                return Err(Mismatch::new(format!("`{}` is a message, not a list", message.full_name())));
            }
            (FieldKind::List(_), Segment::Name(_)) => {
                let error = Mismatch::new(format!("`{}` is a list", path.up_to(index)));
                return Err(error.help(format!("name an element: `{}[0]`", path.up_to(index))));
            }
            (kind, _) => {
                let reason = format!("`{}` is {} and has no fields", path.up_to(index), kind.word());
                return Err(Mismatch::new(reason));
            }
        };
    }
    Ok(reached)
}

fn of_field(field: &FieldDescriptor) -> FieldKind {
    match field.kind() {
        Kind::Message(entry) if field.is_map() => {
            let (key, value) = (entry.map_entry_key_field(), entry.map_entry_value_field());
            FieldKind::Map(Box::new(of_kind(&key.kind())), Box::new(of_kind(&value.kind())))
        }
        kind if field.is_list() => FieldKind::List(Box::new(of_kind(&kind))),
        kind => of_kind(&kind),
    }
}

fn of_kind(kind: &Kind) -> FieldKind {
    match kind {
        Kind::Message(message) => of_message(message),
        Kind::Enum(names) => FieldKind::Enum(names.values().map(|it| it.name().to_owned()).collect()),
        Kind::String => FieldKind::Text,
        Kind::Bytes => FieldKind::Bytes,
        Kind::Bool => FieldKind::Boolean,
        _ => FieldKind::Number,
    }
}

fn of_message(message: &MessageDescriptor) -> FieldKind {
    match short(message) {
        None => FieldKind::Message(message.clone()),
        Some(Short::Text) => FieldKind::Text,
        Some(Short::Wrapper) => message.get_field(1).map_or(FieldKind::Unknown, |field| of_field(&field)),
        Some(Short::Struct | Short::Value | Short::List | Short::Any) => FieldKind::Unknown,
    }
}

/// Returns the columns of a table of messages: the paths of all fields that are not messages, including those of nested
/// messages.
pub(crate) fn columns(message: &MessageDescriptor) -> Vec<FieldPath> {
    let mut columns = Vec::new();
    if let FieldKind::Message(_) = of_message(message) {
        add_columns(message, &FieldPath::default(), &mut vec![message.clone()], &mut columns);
    }
    if columns.is_empty() {
        columns.push(FieldPath::default());
    }
    columns
}

fn add_columns(
    message: &MessageDescriptor,
    above: &FieldPath,
    around: &mut Vec<MessageDescriptor>,
    columns: &mut Vec<FieldPath>,
) {
    for field in message.fields() {
        let path = above.clone().field(field.name());
        match of_field(&field) {
            // A recursive type would have endless columns, so its JSON goes into a single column.
            FieldKind::Message(inner) if inner.fields().len() > 0 && !around.contains(&inner) => {
                around.push(inner.clone());
                add_columns(&inner, &path, around, columns);
                around.pop();
            }
            _ if columns.len() < MAX_COLUMNS => columns.push(path),
            _ => return,
        }
    }
}
