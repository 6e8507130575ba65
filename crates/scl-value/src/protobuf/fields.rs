//! The fields that a message of a type may have.

use super::from_value::known_fields;
use super::well_known::{Short, short};
use crate::error::suggestion;
use crate::field_kind::FieldKind;
use crate::path::{FieldPath, Segment, UnknownField};
use prost_reflect::{FieldDescriptor, Kind, MessageDescriptor};

/// Maximum number of columns of a table.
const MAX_COLUMNS: usize = 1000;

/// What a path has reached.
enum Reached {
    Message(MessageDescriptor),
    List(Box<Reached>),
    /// Its keys and values.
    Map(FieldKind, Box<Reached>),
    /// A number, a text, bytes.
    Scalar(FieldKind),
    /// Anything may be below.
    Anything,
}

/// What the value at a path may be.
///
/// # Errors
/// The message has no such field.
pub(crate) fn kind_of(message: &MessageDescriptor, path: &FieldPath) -> Result<FieldKind, UnknownField> {
    reach(message, path).map(kind_of_reached)
}

fn kind_of_reached(reached: Reached) -> FieldKind {
    match reached {
        Reached::Message(_) => FieldKind::Message,
        Reached::List(item) => FieldKind::List(Box::new(kind_of_reached(*item))),
        Reached::Map(key, _) => FieldKind::Map(Box::new(key)),
        Reached::Scalar(kind) => kind,
        Reached::Anything => FieldKind::Unknown,
    }
}

fn reach(message: &MessageDescriptor, path: &FieldPath) -> Result<Reached, UnknownField> {
    let mut reached = of_message(message);
    for (index, segment) in path.segments().iter().enumerate() {
        let wrong = |reason: String| UnknownField { path: path.up_to(index), reason, help: None, note: None };
        reached = match (reached, segment) {
            (Reached::Anything, _) => return Ok(Reached::Anything),
            (Reached::Message(message), Segment::Name(name)) => match message.get_field_by_name(name) {
                Some(field) => of_field(&field),
                None if name.starts_with('@') => return Ok(Reached::Anything),
                None => {
                    let names: Vec<String> = message.fields().map(|field| field.name().to_owned()).collect();
                    return Err(UnknownField {
                        help: suggestion(name, names.iter().map(String::as_str)),
                        note: Some(known_fields(&message)),
                        ..wrong(format!("message `{}` has no field `{name}`", message.full_name()))
                    });
                }
            },
            (Reached::List(item), Segment::Index(_)) => *item,
            (Reached::Map(_, value), _) => *value,
            (Reached::Message(message), Segment::Index(_)) => {
                return Err(wrong(format!("`{}` is a message, not a list", message.full_name())));
            }
            (Reached::List(_), Segment::Name(_)) => {
                let help = Some(format!("name an element: `{}[0]`", path.up_to(index)));
                return Err(UnknownField { help, ..wrong(format!("`{}` is a list", path.up_to(index))) });
            }
            (Reached::Scalar(kind), _) => {
                let word = kind.word();
                return Err(wrong(format!("`{}` is {word} and has no fields", path.up_to(index))));
            }
        };
    }
    Ok(reached)
}

fn of_field(field: &FieldDescriptor) -> Reached {
    match field.kind() {
        Kind::Message(entry) if field.is_map() => {
            let key = kind_of_reached(of_kind(&entry.map_entry_key_field().kind()));
            Reached::Map(key, Box::new(of_kind(&entry.map_entry_value_field().kind())))
        }
        kind if field.is_list() => Reached::List(Box::new(of_kind(&kind))),
        kind => of_kind(&kind),
    }
}

fn of_kind(kind: &Kind) -> Reached {
    match kind {
        Kind::Message(message) => of_message(message),
        Kind::Enum(names) => Reached::Scalar(FieldKind::Enum(names.values().map(|it| it.name().to_owned()).collect())),
        Kind::String => Reached::Scalar(FieldKind::Text),
        Kind::Bytes => Reached::Scalar(FieldKind::Bytes),
        Kind::Bool => Reached::Scalar(FieldKind::Boolean),
        _ => Reached::Scalar(FieldKind::Number),
    }
}

fn of_message(message: &MessageDescriptor) -> Reached {
    match short(message) {
        None => Reached::Message(message.clone()),
        Some(Short::Text) => Reached::Scalar(FieldKind::Text),
        Some(Short::Wrapper) => message.get_field(1).map_or(Reached::Anything, |field| of_field(&field)),
        Some(Short::Struct | Short::Value | Short::List | Short::Any) => Reached::Anything,
    }
}

/// The columns of a table of messages: all fields that are no messages, those of messages within with their path.
pub(crate) fn columns(message: &MessageDescriptor) -> Vec<FieldPath> {
    let mut columns = Vec::new();
    if let Reached::Message(_) = of_message(message) {
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
            // A type within itself has no end; its JSON stands in one column.
            Reached::Message(inner) if inner.fields().len() > 0 && !around.contains(&inner) => {
                around.push(inner.clone());
                add_columns(&inner, &path, around, columns);
                around.pop();
            }
            _ if columns.len() < MAX_COLUMNS => columns.push(path),
            _ => return,
        }
    }
}
