//! Whether a condition can hold for messages of a type: its fields exist, and their values can be compared.

use super::{Condition, Node, Operand, Operator};
use crate::error::Mismatch;
use crate::field_kind::FieldKind;
use crate::message_type::MessageType;
use crate::path::FieldPath;
use crate::value::Value;
use scl_terminal::{closest_name, quoted_list};

impl Condition {
    /// Checks that the condition can hold for messages of a type. If the type is not known, every field may exist and
    /// have any value.
    ///
    /// # Errors
    /// The type has no such field, a field alone is not a boolean, or values are compared that are never equal, such as
    /// a text and a number.
    pub fn check(&self, messages: &MessageType) -> Result<(), Mismatch> {
        self.root.check(messages)
    }
}

impl Node {
    fn check(&self, messages: &MessageType) -> Result<(), Mismatch> {
        match self {
            Node::Or(nodes) | Node::And(nodes) => nodes.iter().try_for_each(|node| node.check(messages)),
            Node::Not(node) => node.check(messages),
            Node::True(path) => match messages.kind_of(path)? {
                FieldKind::Boolean | FieldKind::Unknown => Ok(()),
                kind => Err(not_boolean(path, &kind)),
            },
            Node::Compare(left, operator, right) => {
                let kinds = (left.kind(messages)?, right.kind(messages).map_err(|error| or_a_text(error, right))?);
                check_comparison((left, &kinds.0), *operator, (right, &kinds.1))
            }
        }
    }
}

impl Operand {
    fn kind(&self, messages: &MessageType) -> Result<FieldKind, Mismatch> {
        match self {
            Operand::Field(path) => messages.kind_of(path),
            Operand::Constant(value) => Ok(FieldKind::of(value)),
        }
    }
}

/// Adds to an error the hint to put a text in quotes: `mode == AUTO`.
fn or_a_text(error: Mismatch, operand: &Operand) -> Mismatch {
    let Operand::Field(path) = operand else { return error };
    Mismatch { help: error.help.or_else(|| Some(format!("put a text in quotes: `'{path}'`"))), ..error }
}

/// The error about a field that stands alone, but is not a boolean.
pub(super) fn not_boolean(path: &FieldPath, kind: &FieldKind) -> Mismatch {
    let example = match kind {
        FieldKind::Number => format!("{path} > 0"),
        FieldKind::Text => format!("{path} == 'text'"),
        FieldKind::Enum(names) => format!("{path} == '{}'", names.first().map_or("", String::as_str)),
        FieldKind::List(_) | FieldKind::Map(..) => format!("{path} contains 1"),
        _ => format!("{path} != null"),
    };
    Mismatch::new(format!("`{path}` is {}, which is neither true nor false", kind.word()))
        .help(format!("compare it, for example `{example}`"))
}

fn check_comparison(
    (left, left_kind): (&Operand, &FieldKind),
    operator: Operator,
    (right, right_kind): (&Operand, &FieldKind),
) -> Result<(), Mismatch> {
    let mismatch =
        |reason: String, help: Option<&str>| Err(help.into_iter().fold(Mismatch::new(reason), Mismatch::help));
    let kinds = || format!("{left} is {}, and {right} is {}", left_kind.word(), right_kind.word());
    match operator {
        Operator::Contains => match (left_kind, right_kind) {
            (FieldKind::Unknown, _) | (_, FieldKind::Unknown) => Ok(()),
            (FieldKind::Text, FieldKind::Text | FieldKind::Enum(_)) => Ok(()),
            (FieldKind::Enum(_), FieldKind::Text | FieldKind::Enum(_)) => Ok(()),
            (FieldKind::Bytes, FieldKind::Bytes) | (FieldKind::Message(_), FieldKind::Text) => Ok(()),
            (FieldKind::List(item), part) | (FieldKind::Map(item, _), part) if item.compares_with(part) => {
                check_names(item, right)
            }
            (FieldKind::List(part) | FieldKind::Map(part, _), _) => {
                let parts = if matches!(left_kind, FieldKind::List(_)) {
                    "a list in which each value"
                } else {
                    "a map in which each key"
                };
                mismatch(format!("{left} is {parts} is {}, and {right} is {}", part.word(), right_kind.word()), None)
            }
            (FieldKind::Boolean | FieldKind::Number | FieldKind::Null, _) => mismatch(
                format!("{left} is {}, which contains nothing", left_kind.word()),
                Some("compare it with `==`"),
            ),
            _ => mismatch(kinds(), None),
        },
        _ if !left_kind.compares_with(right_kind) => mismatch(
            format!("{}: they cannot be compared", kinds()),
            match (left_kind, right_kind) {
                (FieldKind::Text | FieldKind::Enum(_), _) => Some("put a text in quotes: `'text'`"),
                (_, FieldKind::Text | FieldKind::Enum(_)) => Some("put only texts in quotes"),
                (FieldKind::List(_), _) => Some("look for a value with `contains`, or name an element: `[0]`"),
                _ => None,
            },
        ),
        Operator::Equal | Operator::NotEqual => {
            check_names(left_kind, right).and_then(|()| check_names(right_kind, left))
        }
        _ => match [(left, left_kind), (right, right_kind)].into_iter().find(|(_, kind)| !kind.is_ordered()) {
            Some((operand, kind)) => {
                mismatch(format!("{operand} is {}, which has no order", kind.word()), Some("compare it with `==`"))
            }
            None => Ok(()),
        },
    }
}

/// Checks that a text which is compared with enum values is one of their names.
fn check_names(kind: &FieldKind, operand: &Operand) -> Result<(), Mismatch> {
    let (FieldKind::Enum(names), Operand::Constant(Value::Text(text))) = (kind, operand) else { return Ok(()) };
    if names.contains(text) {
        return Ok(());
    }
    let names = || names.iter().map(String::as_str);
    let error = Mismatch::new(format!("{operand} is not the name of an enum value of the field"));
    let near = closest_name(text, names()).map(|near| format!("did you mean `'{near}'`?"));
    Err(near.into_iter().fold(error, Mismatch::help).note(format!("its names: {}", quoted_list(names()))))
}
