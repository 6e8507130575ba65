//! Conditions on messages: `speed > 1.5 and mode == 'AUTO'`.

mod parse;
#[cfg(test)]
mod tests;

use crate::message_type::MessageType;
use crate::path::{FieldPath, UnknownField};
use crate::value::Value;
use scl_terminal::Problem;
use std::cmp::Ordering;
use std::str::FromStr;
use thiserror::Error;

/// A condition on a message.
///
/// Comparisons are `==`, `!=`, `<`, `<=`, `>`, `>=` between fields, numbers, texts in quotes, `true`, `false` and
/// `null`, and `contains` for texts, lists and the keys of maps. They are combined with `not`, `and`, `or` and
/// parentheses. A field alone is true if its value is.
///
/// A comparison of a field that the message does not have is false, and so is one of values that cannot be compared,
/// such as a text with a number, except `!=`.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    root: Node,
}

/// A text is not a condition.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{text}` is not a condition: {reason} at character {}", at + 1)]
pub struct ConditionError {
    text: String,
    /// The number of characters before the mistake.
    at: usize,
    reason: String,
}

#[derive(Debug, Clone, PartialEq)]
enum Node {
    Or(Vec<Node>),
    And(Vec<Node>),
    Not(Box<Node>),
    Compare(Operand, Operator, Operand),
    /// A field that is a boolean.
    True(Operand),
}

#[derive(Debug, Clone, PartialEq)]
enum Operand {
    Field(FieldPath),
    Constant(Value),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Operator {
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Contains,
}

impl Condition {
    /// Whether a message meets the condition.
    pub fn holds(&self, message: &Value) -> bool {
        self.root.holds(message)
    }

    /// The fields that the condition looks at.
    pub fn fields(&self) -> Vec<&FieldPath> {
        let mut fields = Vec::new();
        self.root.add_fields(&mut fields);
        fields
    }

    /// Checks that the messages of a type may have all fields of the condition.
    ///
    /// # Errors
    /// The type has no such field.
    pub fn check(&self, messages: &MessageType) -> Result<(), UnknownField> {
        self.fields().into_iter().try_for_each(|path| messages.check_field(path))
    }
}

impl FromStr for Condition {
    type Err = ConditionError;

    fn from_str(text: &str) -> Result<Self, ConditionError> {
        let root = parse::parse(text).map_err(|(at, reason)| ConditionError {
            text: text.to_owned(),
            at: text.get(..at).unwrap_or(text).chars().count(),
            reason,
        })?;
        Ok(Self { root })
    }
}

impl From<ConditionError> for Problem {
    fn from(error: ConditionError) -> Self {
        Problem::new(error.to_string())
            .help("write for example `speed > 1.5` or `mode == 'AUTO' and not (errors contains 3)`")
    }
}

impl Node {
    fn holds(&self, message: &Value) -> bool {
        match self {
            Node::Or(nodes) => nodes.iter().any(|node| node.holds(message)),
            Node::And(nodes) => nodes.iter().all(|node| node.holds(message)),
            Node::Not(node) => !node.holds(message),
            Node::Compare(left, operator, right) => {
                let (left, right) = (left.find(message), right.find(message));
                left.zip(right).is_some_and(|(left, right)| operator.holds(left, right))
            }
            Node::True(operand) => operand.find(message) == Some(&Value::Bool(true)),
        }
    }

    fn add_fields<'n>(&'n self, fields: &mut Vec<&'n FieldPath>) {
        let operands = match self {
            Node::Or(nodes) | Node::And(nodes) => return nodes.iter().for_each(|node| node.add_fields(fields)),
            Node::Not(node) => return node.add_fields(fields),
            Node::Compare(left, _, right) => vec![left, right],
            Node::True(operand) => vec![operand],
        };
        fields.extend(operands.into_iter().filter_map(|operand| match operand {
            Operand::Field(path) => Some(path),
            Operand::Constant(_) => None,
        }));
    }
}

impl Operand {
    fn find<'v>(&'v self, message: &'v Value) -> Option<&'v Value> {
        match self {
            Operand::Field(path) => path.find(message),
            Operand::Constant(value) => Some(value),
        }
    }
}

impl Operator {
    fn holds(self, left: &Value, right: &Value) -> bool {
        let order = || compare(left, right);
        match self {
            Operator::Equal => equal(left, right),
            Operator::NotEqual => !equal(left, right),
            Operator::Less => order() == Some(Ordering::Less),
            Operator::LessOrEqual => order().is_some_and(Ordering::is_le),
            Operator::Greater => order() == Some(Ordering::Greater),
            Operator::GreaterOrEqual => order().is_some_and(Ordering::is_ge),
            Operator::Contains => contains(left, right),
        }
    }
}

fn equal(left: &Value, right: &Value) -> bool {
    compare(left, right).map_or_else(|| left == right, Ordering::is_eq)
}

/// The order of two numbers or two texts.
fn compare(left: &Value, right: &Value) -> Option<Ordering> {
    if let (Value::Text(left), Value::Text(right)) = (left, right) {
        return Some(left.cmp(right));
    }
    match (integer(left), integer(right)) {
        (Some(left), Some(right)) => Some(left.cmp(&right)),
        _ => left.as_number()?.partial_cmp(&right.as_number()?),
    }
}

/// Whole numbers are compared as such: a float has not enough digits for all of them.
fn integer(value: &Value) -> Option<i128> {
    match value {
        Value::Int(number) => Some((*number).into()),
        Value::Uint(number) => Some((*number).into()),
        _ => None,
    }
}

fn contains(whole: &Value, part: &Value) -> bool {
    match (whole, part) {
        (Value::Text(whole), Value::Text(part)) => whole.contains(part.as_str()),
        (Value::List(items), part) => items.iter().any(|item| equal(item, part)),
        (Value::Map(entries), part) => entries.iter().any(|(key, _)| equal(key, part)),
        (Value::Bytes(whole), Value::Bytes(part)) => part.is_empty() || whole.windows(part.len()).any(|it| it == part),
        _ => false,
    }
}
