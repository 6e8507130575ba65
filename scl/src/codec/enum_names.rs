//! Refuses unknown names of enum values in canonical JSON, while unknown fields are skipped.
//!
//! `prost-reflect` has one option for both, and what it skips leaves no trace in the message. So its deserializer is
//! wrapped, each wrapper knows which part of the schema it reads, and only the names of enum values and of fields are
//! looked at. What an `Any` contains is not checked, because its type may follow after its fields.

use prost_reflect::{EnumDescriptor, FieldDescriptor, Kind, MessageDescriptor};
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde::forward_to_deserialize_any;
use std::cell::RefCell;
use std::fmt;

/// A deserializer of the canonical JSON of `message`.
pub(super) fn checked<D>(message: &MessageDescriptor, inner: D) -> Checked<'static, D> {
    Checked { inner, part: Part::of_kind(Kind::Message(message.clone())) }
}

/// What the schema says of a JSON value.
#[derive(Clone)]
enum Part<'a> {
    Message(MessageDescriptor),
    List(Kind),
    Map(Kind),
    Enum(EnumDescriptor),
    /// The name of a field of the message; its part is stored for the value that follows.
    FieldOf(&'a MessageDescriptor, &'a RefCell<Part<'static>>),
    /// Contains no enum, or is a well-known type with a form of its own.
    Unchecked,
}

impl Part<'static> {
    fn of_kind(kind: Kind) -> Self {
        match kind {
            Kind::Message(message) if message.package_name() == "google.protobuf" => Self::Unchecked,
            Kind::Message(message) => Self::Message(message),
            Kind::Enum(values) => Self::Enum(values),
            _ => Self::Unchecked,
        }
    }

    fn of_field(field: &FieldDescriptor) -> Self {
        match field.kind() {
            Kind::Message(entry) if field.is_map() => Self::Map(entry.map_entry_value_field().kind()),
            kind if field.is_list() => Self::List(kind),
            kind => Self::of_kind(kind),
        }
    }
}

/// Wraps a deserializer, a visitor, a seed, or the access to elements.
pub(super) struct Checked<'a, I> {
    inner: I,
    part: Part<'a>,
}

impl<'de, D: Deserializer<'de>> Deserializer<'de> for Checked<'_, D> {
    type Error = D::Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.inner.deserialize_any(Checked { inner: visitor, part: self.part })
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.inner.deserialize_option(Checked { inner: visitor, part: self.part })
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.inner.deserialize_ignored_any(visitor)
    }

    fn is_human_readable(&self) -> bool {
        self.inner.is_human_readable()
    }

    // Canonical JSON is only deserialized from self-describing formats, so all of these can use `deserialize_any`.
    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct
        newtype_struct seq tuple tuple_struct map struct enum identifier
    }
}

impl<'de, V: Visitor<'de>> Visitor<'de> for Checked<'_, V> {
    type Value = V::Value;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.inner.expecting(formatter)
    }

    visit_plain! {
        visit_bool(v: bool) visit_i64(v: i64) visit_i128(v: i128) visit_u64(v: u64) visit_u128(v: u128)
        visit_f64(v: f64) visit_bytes(v: &[u8]) visit_borrowed_bytes(v: &'de [u8]) visit_byte_buf(v: Vec<u8>)
        visit_none() visit_unit()
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<V::Value, E> {
        match &self.part {
            Part::Enum(values) if values.get_value_by_name(text).is_none() => {
                // Protobuf libraries in other languages also accept the number of an enum value as text.
                let number = text.parse().ok().filter(|_| !text.starts_with('+'));
                let number = number.filter(|number| values.get_value(*number).is_some());
                let unknown =
                    || E::custom(format_args!("`{text}` is not a value of the enum `{}`", values.full_name()));
                self.inner.visit_i64(number.ok_or_else(unknown)?.into())
            }
            Part::FieldOf(message, part) => {
                let field = message.get_field_by_json_name(text).or_else(|| message.get_field_by_name(text));
                part.replace(field.as_ref().map_or(Part::Unchecked, Part::of_field));
                self.inner.visit_str(text)
            }
            _ => self.inner.visit_str(text),
        }
    }

    fn visit_some<D: Deserializer<'de>>(self, content: D) -> Result<V::Value, D::Error> {
        self.inner.visit_some(Checked { inner: content, part: self.part })
    }

    fn visit_newtype_struct<D: Deserializer<'de>>(self, content: D) -> Result<V::Value, D::Error> {
        self.inner.visit_newtype_struct(Checked { inner: content, part: self.part })
    }

    fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<V::Value, A::Error> {
        let part = if let Part::List(kind) = self.part { Part::of_kind(kind) } else { Part::Unchecked };
        self.inner.visit_seq(Checked { inner: elements, part })
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<V::Value, A::Error> {
        let (message, value) = match self.part {
            Part::Message(message) => (Some(message), Part::Unchecked),
            Part::Map(kind) => (None, Part::of_kind(kind)),
            _ => (None, Part::Unchecked),
        };
        self.inner.visit_map(Entries { inner: entries, message, value: RefCell::new(value) })
    }
}

impl<'de, S: DeserializeSeed<'de>> DeserializeSeed<'de> for Checked<'_, S> {
    type Value = S::Value;

    fn deserialize<D: Deserializer<'de>>(self, input: D) -> Result<S::Value, D::Error> {
        self.inner.deserialize(Checked { inner: input, part: self.part })
    }
}

impl<'de, A: SeqAccess<'de>> SeqAccess<'de> for Checked<'_, A> {
    type Error = A::Error;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, A::Error> {
        self.inner.next_element_seed(Checked { inner: seed, part: self.part.clone() })
    }

    fn size_hint(&self) -> Option<usize> {
        self.inner.size_hint()
    }
}

/// The fields of `message`, or the entries of a map.
struct Entries<A> {
    inner: A,
    message: Option<MessageDescriptor>,
    /// The part of the next value.
    value: RefCell<Part<'static>>,
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for Entries<A> {
    type Error = A::Error;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, A::Error> {
        match &self.message {
            Some(message) => {
                self.inner.next_key_seed(Checked { inner: seed, part: Part::FieldOf(message, &self.value) })
            }
            None => self.inner.next_key_seed(seed),
        }
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, A::Error> {
        let part = self.value.borrow().clone();
        self.inner.next_value_seed(Checked { inner: seed, part })
    }

    fn size_hint(&self) -> Option<usize> {
        self.inner.size_hint()
    }
}
