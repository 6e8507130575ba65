//! What a field of a type holds, as far as the type says so.

use crate::value::Value;
use prost_reflect::MessageDescriptor;

/// What values a field, or the value at a path, may have.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum FieldKind {
    Boolean,
    Number,
    Text,
    /// A text that is one of these, or the number of a value that the type does not know.
    Enum(Vec<String>),
    Bytes,
    List(Box<FieldKind>),
    /// Its keys and values.
    Map(Box<FieldKind>, Box<FieldKind>),
    Message(MessageDescriptor),
    Null,
    /// Anything, because nothing describes it.
    Unknown,
}

impl FieldKind {
    /// The kind of a value.
    pub(crate) fn of(value: &Value) -> Self {
        match value.meaning() {
            Value::Null => Self::Null,
            Value::Bool(_) => Self::Boolean,
            Value::Int(_) | Value::Uint(_) | Value::Float(_) => Self::Number,
            Value::Text(_) => Self::Text,
            Value::Bytes(_) => Self::Bytes,
            Value::List(_) => Self::List(Box::new(Self::Unknown)),
            Value::Map(_) => Self::Map(Box::new(Self::Unknown), Box::new(Self::Unknown)),
            Value::Opaque(_) | Value::Written(_) => Self::Unknown,
        }
    }

    /// For messages: `a number`.
    pub(crate) fn word(&self) -> &'static str {
        match self {
            Self::Boolean => "a boolean",
            Self::Number => "a number",
            Self::Text => "a text",
            Self::Enum(_) => "the name of an enum value",
            Self::Bytes => "bytes",
            Self::List(_) => "a list",
            Self::Map(..) => "a map",
            Self::Message(_) => "a message",
            Self::Null => "null",
            Self::Unknown => "of an unknown type",
        }
    }

    /// Whether values of both may be equal, or one less than the other.
    pub(crate) fn compares_with(&self, other: &Self) -> bool {
        self.family().zip(other.family()).is_none_or(|(own, others)| own == others)
    }

    /// The word of a group of kinds that can be compared with each other; `None` for kinds that can be compared with
    /// all.
    fn family(&self) -> Option<&'static str> {
        match self {
            Self::Unknown | Self::Null => None,
            Self::Enum(_) => Some(Self::Text.word()),
            Self::Message(_) => Some("a map"),
            kind => Some(kind.word()),
        }
    }

    /// Whether values have an order.
    pub(crate) fn is_ordered(&self) -> bool {
        matches!(self, Self::Number | Self::Text | Self::Enum(_) | Self::Unknown)
    }
}

impl Value {
    /// What this is, for messages: `a number`.
    pub(crate) fn kind(&self) -> &'static str {
        match self.meaning() {
            Value::Opaque(_) | Value::Written(_) => "an undecoded payload",
            value => FieldKind::of(value).word(),
        }
    }
}
