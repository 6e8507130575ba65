//! The fields that a message of a type may have.

use super::from_value::known_fields;
use super::well_known::{Short, short};
use crate::path::{FieldPath, Segment, UnknownField};
use prost_reflect::{FieldDescriptor, Kind, MessageDescriptor};
use scl_terminal::closest_name;

/// Maximum number of columns of a table.
const MAX_COLUMNS: usize = 1000;

/// What a path has reached.
enum Reached {
    Message(MessageDescriptor),
    List(Box<Reached>),
    Map(Box<Reached>),
    /// A number, a text, bytes.
    Scalar(&'static str),
    /// Anything may be below.
    Anything,
}

/// Checks that a message may have a field.
pub(crate) fn check_field(message: &MessageDescriptor, path: &FieldPath) -> Result<(), UnknownField> {
    let mut reached = of_message(message);
    for (index, segment) in path.segments().iter().enumerate() {
        let wrong = |reason: String| UnknownField { path: path.up_to(index), reason, help: None, note: None };
        reached = match (reached, segment) {
            (Reached::Anything, _) => return Ok(()),
            (Reached::Message(message), Segment::Name(name)) => match message.get_field_by_name(name) {
                Some(field) => of_field(&field),
                None if name.starts_with('@') => return Ok(()),
                None => {
                    let names: Vec<String> = message.fields().map(|field| field.name().to_owned()).collect();
                    let near = closest_name(name, names.iter().map(String::as_str));
                    return Err(UnknownField {
                        help: near.map(|near| format!("did you mean `{near}`?")),
                        note: Some(known_fields(&message)),
                        ..wrong(format!("message `{}` has no field `{name}`", message.full_name()))
                    });
                }
            },
            (Reached::List(item), Segment::Index(_)) => *item,
            (Reached::Map(value), _) => *value,
            (Reached::Message(message), Segment::Index(_)) => {
                return Err(wrong(format!("`{}` is a message, not a list", message.full_name())));
            }
            (Reached::List(_), Segment::Name(_)) => {
                let help = Some(format!("name an element: `{}[0]`", path.up_to(index)));
                return Err(UnknownField { help, ..wrong(format!("`{}` is a list", path.up_to(index))) });
            }
            (Reached::Scalar(word), _) => {
                return Err(wrong(format!("`{}` is {word} and has no fields", path.up_to(index))));
            }
        };
    }
    Ok(())
}

fn of_field(field: &FieldDescriptor) -> Reached {
    match field.kind() {
        Kind::Message(entry) if field.is_map() => {
            Reached::Map(Box::new(of_kind(&entry.map_entry_value_field().kind())))
        }
        kind if field.is_list() => Reached::List(Box::new(of_kind(&kind))),
        kind => of_kind(&kind),
    }
}

fn of_kind(kind: &Kind) -> Reached {
    match kind {
        Kind::Message(message) => of_message(message),
        Kind::String | Kind::Enum(_) => Reached::Scalar("a text"),
        Kind::Bytes => Reached::Scalar("bytes"),
        Kind::Bool => Reached::Scalar("a boolean"),
        _ => Reached::Scalar("a number"),
    }
}

fn of_message(message: &MessageDescriptor) -> Reached {
    match short(message) {
        None => Reached::Message(message.clone()),
        Some(Short::Text) => Reached::Scalar("a text"),
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
