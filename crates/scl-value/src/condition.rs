//! Conditions on messages: `speed > 1.5 and mode == 'AUTO'`.

mod check;
mod parse;
#[cfg(test)]
mod tests;

use crate::error::Mismatch;
use crate::field_kind::FieldKind;
use crate::path::FieldPath;
use crate::value::{Value, to_json};
use check::not_boolean;
use scl_terminal::Problem;
use std::cmp::Ordering;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A condition on a message.
///
/// Comparisons are `==`, `!=`, `<`, `<=`, `>`, `>=` between fields, numbers, texts in quotes, `true`, `false` and
/// `null`, and `contains` for texts, lists and the keys of maps. They are combined with `not`, `and`, `or` and
/// parentheses. A field alone must be a boolean.
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
    True(FieldPath),
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
    ///
    /// # Errors
    /// A field alone is not a boolean in this message. [`check`](Self::check) finds that without a message if the type
    /// is known.
    pub fn holds(&self, message: &Value) -> Result<bool, Mismatch> {
        self.root.holds(message)
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
    fn holds(&self, message: &Value) -> Result<bool, Mismatch> {
        Ok(match self {
            Node::Or(nodes) => is_one(nodes, message, true)?,
            Node::And(nodes) => !is_one(nodes, message, false)?,
            Node::Not(node) => !node.holds(message)?,
            Node::Compare(left, operator, right) => {
                let (left, right) = (left.find(message), right.find(message));
                left.zip(right).is_some_and(|(left, right)| operator.holds(left, right))
            }
            Node::True(path) => match path.find(message) {
                Some(Value::Bool(value)) => *value,
                None | Some(Value::Null | Value::Opaque(_)) => false,
                Some(value) => return Err(not_boolean(path, &FieldKind::of(value))),
            },
        })
    }
}

/// Whether `holds` returns `expected` for at least one of the nodes.
fn is_one(nodes: &[Node], message: &Value, expected: bool) -> Result<bool, Mismatch> {
    for node in nodes {
        if node.holds(message)? == expected {
            return Ok(true);
        }
    }
    Ok(false)
}

/// For messages: `` `speed` ``.
impl fmt::Display for Operand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Operand::Field(path) => write!(f, "`{path}`"),
            Operand::Constant(Value::Text(text)) => write!(f, "`'{text}'`"),
            Operand::Constant(value) => write!(f, "`{}`", to_json(value)),
        }
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

/// The order of two numbers or two texts; `None` for other values and for NaN.
fn compare(left: &Value, right: &Value) -> Option<Ordering> {
    if let (Value::Text(left), Value::Text(right)) = (left, right) {
        return Some(left.cmp(right));
    }
    match (integer(left), integer(right)) {
        (Some(left), Some(right)) => Some(left.cmp(&right)),
        _ => left.as_number()?.partial_cmp(&right.as_number()?),
    }
}

/// Whole numbers are compared as integers, because a float cannot represent all of them exactly.
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
