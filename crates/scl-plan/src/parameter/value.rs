//! The values of parameters, read from texts.

use super::items::items;
use super::{ParameterPlan, ParameterType, Scalar};
use scl_text::duration::parse_duration;
use scl_text::excerpt::excerpt;
use scl_text::list::either;
use std::cmp::Ordering;
use std::time::Duration;

/// The longest text of a value, in bytes. The operating system bounds what a program can be given.
pub const LONGEST_VALUE: usize = 64 << 10;

/// The value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum ParameterValue {
    /// A switch.
    Bool(bool),
    /// A whole number; the type says how large it can be.
    Integer(i128),
    /// A finite number.
    Float(f64),
    /// A text, or one of the words of a choice.
    Text(String),
    /// A duration.
    Duration(Duration),
    /// The values of a list.
    List(Vec<ParameterValue>),
}

impl ParameterPlan {
    /// Reads a value, and checks that it is in the range.
    ///
    /// # Errors
    /// Why it cannot be the value: `expected a whole number from 0 to 255`.
    pub fn read(&self, text: &str) -> Result<ParameterValue, String> {
        let value = self.kind.read(text)?;
        let Some((least, largest)) = self.bounds() else { return Ok(value) };
        let is_within = |value: &ParameterValue| {
            let (below, above) = (order(value, &least), order(value, &largest));
            below.is_some_and(Ordering::is_ge) && above.is_some_and(Ordering::is_le)
        };
        let is_within = match &value {
            ParameterValue::List(values) => values.iter().all(is_within),
            value => is_within(value),
        };
        let (least, largest) = self.range.as_ref().map_or(("", ""), |(least, largest)| (least, largest));
        match is_within {
            true => Ok(value),
            false => Err(format!("`{}` is not from {least} to {largest}", excerpt(text))),
        }
    }

    /// The range as values, the smaller one first; `None` if there is none, or it is not one.
    pub fn bounds(&self) -> Option<(ParameterValue, ParameterValue)> {
        let (least, largest) = self.range.as_ref()?;
        let scalar = self.kind.scalar()?;
        let bounds = (scalar.read(least).ok()?, scalar.read(largest).ok()?);
        order(&bounds.0, &bounds.1)?.is_le().then_some(bounds)
    }
}

impl ParameterType {
    /// Reads a value.
    ///
    /// # Errors
    /// Why it cannot be the value.
    pub fn read(&self, text: &str) -> Result<ParameterValue, String> {
        if text.len() > LONGEST_VALUE {
            return Err(format!("the value has {} bytes, and may have {LONGEST_VALUE}", text.len()));
        }
        match self {
            ParameterType::One(scalar) => scalar.read(text),
            ParameterType::OneOf(words) => {
                let word = text.trim();
                match words.iter().any(|known| known == word) {
                    true => Ok(ParameterValue::Text(word.to_owned())),
                    false => Err(format!("expected {}, found `{}`", either(words), excerpt(word))),
                }
            }
            ParameterType::List(scalar, length) => {
                let items = items(text)?;
                let found = items.len();
                if let Some(length) = length.filter(|length| *length as usize != found) {
                    return Err(format!("expected {length} items, found {found}"));
                }
                items.iter().map(|item| scalar.read(item)).collect::<Result<_, _>>().map(ParameterValue::List)
            }
        }
    }
}

impl Scalar {
    /// Reads a single value.
    ///
    /// # Errors
    /// Why it cannot be the value.
    pub fn read(self, text: &str) -> Result<ParameterValue, String> {
        // Spaces belong to a text.
        let word = if self == Scalar::Text { text } else { text.trim() };
        match self {
            Scalar::Bool => match word {
                "true" => Ok(ParameterValue::Bool(true)),
                "false" => Ok(ParameterValue::Bool(false)),
                _ => Err(format!("expected `true` or `false`, found `{}`", excerpt(word))),
            },
            Scalar::F32 => float(word, word.parse::<f32>().ok().filter(|it| it.is_finite()).map(f64::from)),
            Scalar::F64 => float(word, word.parse::<f64>().ok().filter(|it| it.is_finite())),
            Scalar::Text if word.contains('\0') => Err("a text cannot have NUL characters".to_owned()),
            Scalar::Text => Ok(ParameterValue::Text(word.to_owned())),
            Scalar::Duration => parse_duration(word).map(ParameterValue::Duration),
            integer => {
                let (least, largest) = integer.limits();
                let number = word.parse::<i128>().ok().filter(|it| (least..=largest).contains(it));
                let expected =
                    || format!("expected a whole number from {least} to {largest}, found `{}`", excerpt(word));
                number.map(ParameterValue::Integer).ok_or_else(expected)
            }
        }
    }

    /// The least and the largest whole number of the type.
    fn limits(self) -> (i128, i128) {
        match self {
            Scalar::I8 => (i8::MIN.into(), i8::MAX.into()),
            Scalar::I16 => (i16::MIN.into(), i16::MAX.into()),
            Scalar::I32 => (i32::MIN.into(), i32::MAX.into()),
            Scalar::I64 => (i64::MIN.into(), i64::MAX.into()),
            Scalar::U8 => (0, u8::MAX.into()),
            Scalar::U16 => (0, u16::MAX.into()),
            Scalar::U32 => (0, u32::MAX.into()),
            Scalar::U64 => (0, u64::MAX.into()),
            Scalar::Bool | Scalar::F32 | Scalar::F64 | Scalar::Text | Scalar::Duration => (0, 0),
        }
    }
}

fn float(word: &str, number: Option<f64>) -> Result<ParameterValue, String> {
    number.map(ParameterValue::Float).ok_or_else(|| format!("expected a finite number, found `{}`", excerpt(word)))
}

/// The order of two values of the same type that can have a range.
fn order(a: &ParameterValue, b: &ParameterValue) -> Option<Ordering> {
    match (a, b) {
        (ParameterValue::Integer(a), ParameterValue::Integer(b)) => Some(a.cmp(b)),
        (ParameterValue::Float(a), ParameterValue::Float(b)) => a.partial_cmp(b),
        (ParameterValue::Duration(a), ParameterValue::Duration(b)) => Some(a.cmp(b)),
        _ => None,
    }
}
