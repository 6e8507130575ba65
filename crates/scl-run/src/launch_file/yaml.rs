//! The YAML of a launch file as values. What programs get, commands and variables, is the text that was written: YAML
//! would make `104` of `0x68`, and `1.1` of `1.10`.

use super::keys::{Form, form_of};
use super::reader::shown;
use serde::de::{Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error, IgnoredAny};
use serde::de::{MapAccess, SeqAccess, VariantAccess, Visitor};
use serde_yaml::value::{Tag, TaggedValue};
use serde_yaml::{Mapping, Value};
use std::fmt;

/// Reads a launch file. The first reading finds lists and mappings, the second one the texts of scalars.
pub(super) fn read(text: &str) -> Result<Value, serde_yaml::Error> {
    let first = AnyValue.deserialize(serde_yaml::Deserializer::from_str(text))?;
    Written { first, at: At::Top }.deserialize(serde_yaml::Deserializer::from_str(text))
}

/// Reads any value. Unlike those of [`Value`] itself, numbers may have more than 64 bits: they are texts.
struct AnyValue;

impl<'de> DeserializeSeed<'de> for AnyValue {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, input: D) -> Result<Value, D::Error> {
        input.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for AnyValue {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("any YAML value")
    }

    fn visit_bool<E>(self, flag: bool) -> Result<Value, E> {
        Ok(flag.into())
    }

    fn visit_i64<E>(self, number: i64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_u64<E>(self, number: u64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_i128<E>(self, number: i128) -> Result<Value, E> {
        Ok(number.to_string().into())
    }

    fn visit_u128<E>(self, number: u128) -> Result<Value, E> {
        Ok(number.to_string().into())
    }

    fn visit_f64<E>(self, number: f64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_str<E>(self, text: &str) -> Result<Value, E> {
        Ok(text.into())
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut input: A) -> Result<Value, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = input.next_element_seed(AnyValue)? {
            items.push(item);
        }
        Ok(Value::Sequence(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut input: A) -> Result<Value, A::Error> {
        let mut entries = Mapping::new();
        while let Some(key) = input.next_key_seed(AnyValue)? {
            if entries.contains_key(&key) {
                let key = key.as_str().map_or_else(|| shown(&key), |key| format!("{key:?}"));
                return Err(A::Error::custom(format!("duplicate entry with key {key}")));
            }
            entries.insert(key, input.next_value_seed(AnyValue)?);
        }
        Ok(Value::Mapping(entries))
    }

    fn visit_enum<A: EnumAccess<'de>>(self, input: A) -> Result<Value, A::Error> {
        let (tag, content) = input.variant::<String>()?;
        let value = content.newtype_variant_seed(AnyValue)?;
        Ok(Value::Tagged(Box::new(TaggedValue { tag: Tag::new(tag), value })))
    }
}

/// The second reading of a value.
struct Written {
    first: Value,
    at: At,
}

/// Where in a launch file a value stands.
#[derive(Debug, Clone, Copy)]
enum At {
    Top,
    /// Mappings from names to mappings, this many levels deep.
    Names(usize),
    /// A mapping with keys of the format.
    Keys,
    /// A list of words; one word alone is a text of YAML.
    Command,
    Variables,
    /// What is passed to a program.
    Text,
    Other,
}

impl At {
    /// Where the value of a key stands.
    fn below(self, key: &Value) -> Self {
        match (self, key.as_str().unwrap_or_default()) {
            (At::Top, "components" | "hosts") => At::Names(1),
            (At::Top, "profiles") => At::Names(2),
            (At::Top, "defaults" | "gateway") => At::Keys,
            (At::Top | At::Keys, key) => match form_of(key) {
                Form::Command => At::Command,
                Form::Variables => At::Variables,
                _ => At::Other,
            },
            (At::Names(0 | 1), _) => At::Keys,
            (At::Names(levels), _) => At::Names(levels - 1),
            (At::Command | At::Variables, _) => At::Text,
            (At::Text | At::Other, _) => At::Other,
        }
    }
}

impl<'de> DeserializeSeed<'de> for Written {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, input: D) -> Result<Value, D::Error> {
        match (self.at, &self.first) {
            (At::Command, Value::Sequence(_)) => input.deserialize_seq(self),
            (At::Top | At::Names(_) | At::Keys | At::Variables, Value::Mapping(_)) => input.deserialize_map(self),
            (At::Text, Value::Number(_) | Value::Bool(_) | Value::String(_)) => {
                String::deserialize(input).map(Value::String)
            }
            _ => IgnoredAny::deserialize(input).map(|_| self.first),
        }
    }
}

impl<'de> Visitor<'de> for Written {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the list or mapping of the first reading")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut input: A) -> Result<Value, A::Error> {
        let Value::Sequence(items) = self.first else { return Err(A::Error::custom("this was no list")) };
        let mut written = Vec::with_capacity(items.len());
        for first in items {
            written.extend(input.next_element_seed(Written { first, at: At::Text })?);
        }
        // A list of YAML ends only when it is asked for more.
        input.next_element::<IgnoredAny>()?;
        Ok(Value::Sequence(written))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut input: A) -> Result<Value, A::Error> {
        let Value::Mapping(entries) = self.first else { return Err(A::Error::custom("this was no mapping")) };
        let mut written = Mapping::with_capacity(entries.len());
        for (key, first) in entries {
            let at = self.at.below(&key);
            let key_at = if matches!(self.at, At::Variables) { At::Text } else { At::Other };
            if let Some(key) = input.next_key_seed(Written { first: key, at: key_at })? {
                written.insert(key, input.next_value_seed(Written { first, at })?);
            }
        }
        input.next_key::<IgnoredAny>()?;
        Ok(Value::Mapping(written))
    }
}
