//! A message as a dynamically typed value.

mod canonical;
mod serialize;

pub(crate) use canonical::canonical;
pub use serialize::to_json;
pub(crate) use serialize::{DATA, EXTENSION, Format, InFormat};

/// A decoded message or a part of it.
///
/// Numbers are [`Int`](Value::Int) whenever they fit, so that equal numbers are equal values, however they are written.
#[derive(Debug, Clone)]
pub enum Value {
    /// Nothing: `null` in JSON and YAML.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// A whole number above the range of `Int`.
    Uint(u64),
    /// Any other number. A 32-bit number becomes the 64-bit one with the same shortest text: 1.84, not 1.8400000334.
    Float(f64),
    /// A text.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
    /// A list.
    List(Vec<Value>),
    /// A map or the fields of a message, in the order of the message. Keys are usually texts; CBOR, MessagePack and
    /// protobuf have others, too.
    Map(Vec<(Value, Value)>),
    /// A payload that cannot be decoded without its type.
    Opaque(Opaque),
    /// A scalar that [`read_yaml`](crate::read_yaml) has read, if its meaning alone does not tell how it was written.
    Written(Box<Written>),
}

/// A scalar of YAML: `0x10` means 16.
#[derive(Debug, Clone)]
pub struct Written {
    /// What was written.
    pub text: String,
    /// What it means in YAML; never a list or map.
    pub meaning: Value,
}

/// A payload that is shown as bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Opaque {
    /// Its length in bytes.
    pub length: usize,
    /// Its first [`SHOWN`](Opaque::SHOWN) bytes in hexadecimal; `...` follows if there are more.
    pub hex: String,
    /// Why it is not decoded.
    pub why: String,
}

impl Opaque {
    /// Maximum number of bytes in `hex`.
    pub const SHOWN: usize = 4096;

    /// A payload of these bytes, and why it is not decoded.
    pub fn new(bytes: &[u8], why: impl Into<String>) -> Self {
        let mut hex: String = bytes.iter().take(Self::SHOWN).map(|byte| format!("{byte:02x}")).collect();
        if bytes.len() > Self::SHOWN {
            hex.push_str("...");
        }
        Self { length: bytes.len(), hex, why: why.into() }
    }

    /// Returns the map that is printed.
    pub(crate) fn fields(&self) -> Value {
        let length = i64::try_from(self.length).unwrap_or(i64::MAX);
        Value::fields([("length", length.into()), ("hex", self.hex.as_str().into()), ("why", self.why.as_str().into())])
    }
}

impl Value {
    /// A map with texts as keys.
    pub fn fields<'n>(fields: impl IntoIterator<Item = (&'n str, Value)>) -> Self {
        Value::Map(fields.into_iter().map(|(name, value)| (name.into(), value)).collect())
    }

    /// The value of a field, or of the key with this text. `None` if this is not a map or has no such key.
    pub fn get(&self, name: &str) -> Option<&Value> {
        let Value::Map(entries) = self else { return None };
        let is_named = |key: &Value| matches!(key, Value::Text(text) if text == name);
        let by_name = entries.iter().find(|(key, _)| is_named(key));
        by_name.or_else(|| entries.iter().find(|(key, _)| key_text(key) == name)).map(|(_, value)| value)
    }

    /// The value without the text that was written for it.
    pub fn meaning(&self) -> &Value {
        match self {
            Value::Written(written) => &written.meaning,
            value => value,
        }
    }

    /// A number of any kind as a float, for comparisons; `None` for other values. Whole numbers beyond 2^53 are
    /// rounded.
    pub fn as_number(&self) -> Option<f64> {
        match self.meaning() {
            Value::Int(number) => Some(*number as f64),
            Value::Uint(number) => Some(*number as f64),
            Value::Float(number) => Some(*number),
            _ => None,
        }
    }

    /// Replaces whole numbers beyond 2^53 by texts, because most readers of JSON would round them; keys are texts
    /// anyway.
    #[must_use]
    pub fn with_large_numbers_as_texts(self) -> Self {
        match self {
            Value::Int(number) if number.unsigned_abs() > EXACT => Value::Text(number.to_string()),
            Value::Uint(number) => Value::Text(number.to_string()),
            Value::List(items) => Value::List(items.into_iter().map(Self::with_large_numbers_as_texts).collect()),
            Value::Map(entries) => {
                let entries = entries.into_iter().map(|(key, value)| (key, value.with_large_numbers_as_texts()));
                Value::Map(entries.collect())
            }
            other => other,
        }
    }
}

impl PartialEq for Value {
    fn eq(&self, other: &Self) -> bool {
        match (self.meaning(), other.meaning()) {
            (Value::Null, Value::Null) => true,
            (Value::Bool(one), Value::Bool(other)) => one == other,
            (Value::Int(one), Value::Int(other)) => one == other,
            (Value::Uint(one), Value::Uint(other)) => one == other,
            (Value::Float(one), Value::Float(other)) => one == other,
            (Value::Text(one), Value::Text(other)) => one == other,
            (Value::Bytes(one), Value::Bytes(other)) => one == other,
            (Value::List(one), Value::List(other)) => one == other,
            (Value::Map(one), Value::Map(other)) => one == other,
            (Value::Opaque(one), Value::Opaque(other)) => one == other,
            _ => false,
        }
    }
}

/// Up to this number, a float represents every whole number exactly.
const EXACT: u64 = 1 << 53;

/// A key of a map as the text that a field path and JSON use.
pub fn key_text(key: &Value) -> String {
    match key {
        Value::Text(text) => text.clone(),
        Value::Written(written) => written.text.clone(),
        Value::Int(number) => number.to_string(),
        Value::Uint(number) => number.to_string(),
        Value::Bool(flag) => flag.to_string(),
        other => to_json(other),
    }
}

/// Converts a 32-bit number to the 64-bit one with the same shortest text.
pub(crate) fn widen(number: f32) -> f64 {
    if number.is_finite() { format!("{number:e}").parse().unwrap_or(f64::from(number)) } else { f64::from(number) }
}

macro_rules! from {
    ($($variant:ident($type:ty))*) => {$(
        impl From<$type> for Value {
            fn from(value: $type) -> Self {
                Value::$variant(value)
            }
        }
    )*};
}

from! { Bool(bool) Int(i64) Float(f64) Text(String) }

impl From<u64> for Value {
    fn from(number: u64) -> Self {
        i64::try_from(number).map_or(Value::Uint(number), Value::Int)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Value::Text(text.to_owned())
    }
}
