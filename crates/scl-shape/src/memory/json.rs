//! Walks through a text of canonical JSON.
//!
//! Every decoder creates more than the message from it: Rust a dynamic message and the protobuf encoding, Python
//! dictionaries, C++ the protobuf encoding. The constants are those of Rust, which are the largest.

use super::{Cost, Kind, Language, MessageLayout};
use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::cell::Cell;
use std::fmt;

/// A slot for a value in a list or map, twice, because either may have twice the capacity that it needs.
const PLACE: u64 = 2 * 64;
/// A map entry; while a map grows, its smaller predecessor still exists.
const ENTRY: u64 = 5 * 96;
/// What a message with at least one field takes: a node of a `BTreeMap` with room for 11 values.
const NODE: u64 = 640;
/// A value of `google.protobuf.Value`, `Struct` and `ListValue`, twice: each is a message in a message.
const ANY: u64 = 4 * NODE;
/// How often a text is copied: into the dynamic message, its encoding, and the message.
const COPIES: u64 = 3;
/// What a value of an unknown field takes in Python and C++.
const IGNORED: u64 = 128;

pub(super) fn most_per_byte(messages: &[MessageLayout]) -> u64 {
    let fields = messages.iter().flat_map(|message| &message.fields);
    let largest = fields.map(|field| field.cost.first).max().unwrap_or(0);
    let any = if messages.iter().any(|message| message.is_well_known) { ANY } else { 0 };
    (largest.saturating_add(any + NODE + ENTRY + 2 * PLACE)) / 2 + COPIES
}

pub(super) fn estimate(messages: &[MessageLayout], language: Language, text: &[u8]) -> Result<u64, serde_json::Error> {
    let total = Cell::new(messages[0].size.saturating_add(COPIES * text.len() as u64));
    let mut input = serde_json::Deserializer::from_slice(text);
    let walk = Walk { messages, language, total: &total };
    Value { walk, part: Part::Message(0), cost: Cost { first: 0, next: 0 }, is_next: true }.deserialize(&mut input)?;
    Ok(total.get())
}

#[derive(Clone, Copy)]
struct Walk<'m> {
    messages: &'m [MessageLayout],
    language: Language,
    total: &'m Cell<u64>,
}

impl<'m> Walk<'m> {
    fn add(&self, bytes: u64) {
        self.total.set(self.total.get().saturating_add(bytes));
    }

    fn part(&self, kind: Kind) -> Part {
        match kind {
            Kind::Message(inner) if self.messages[inner].is_well_known => Part::Any,
            Kind::Message(inner) => Part::Message(inner),
            Kind::Map(entry) => Part::Map(entry),
            Kind::Text | Kind::Number { .. } => Part::Plain,
        }
    }
}

/// What the schema says of a JSON value.
#[derive(Clone, Copy)]
enum Part {
    Message(usize),
    Map(usize),
    /// A well-known type.
    Any,
    Plain,
    /// A value of an unknown field. No language keeps it, but Python and C++ decode it before they discard it.
    Unknown,
}

/// A value, and what it takes in the message.
struct Value<'m> {
    walk: Walk<'m>,
    part: Part,
    cost: Cost,
    is_next: bool,
}

impl Value<'_> {
    fn count(&self) {
        self.walk.add(if self.is_next { self.cost.next } else { self.cost.first });
        match self.part {
            Part::Any => self.walk.add(ANY),
            Part::Unknown => self.walk.add(IGNORED),
            Part::Message(_) | Part::Map(_) | Part::Plain => {}
        }
    }
}

impl<'de> DeserializeSeed<'de> for Value<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, input: D) -> Result<(), D::Error> {
        input.deserialize_any(self)
    }
}

macro_rules! count {
    ($($method:ident($type:ty))*) => {$(
        fn $method<E: Error>(self, _: $type) -> Result<(), E> {
            self.count();
            Ok(())
        }
    )*};
}

impl<'de> Visitor<'de> for Value<'_> {
    type Value = ();

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a JSON value")
    }

    count! { visit_bool(bool) visit_i64(i64) visit_u64(u64) visit_f64(f64) visit_str(&str) }

    fn visit_unit<E: Error>(self) -> Result<(), E> {
        self.count();
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<(), A::Error> {
        if matches!(self.part, Part::Any | Part::Unknown) {
            self.count();
        }
        let mut is_next = false;
        loop {
            let element = Value { walk: self.walk, part: self.part, cost: self.cost, is_next };
            if elements.next_element_seed(element)?.is_none() {
                return Ok(());
            }
            self.walk.add(if is_next { PLACE } else { 2 * PLACE });
            is_next = true;
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<(), A::Error> {
        if !matches!(self.part, Part::Map(_)) {
            self.count();
        }
        let mut is_next = false;
        loop {
            let value = match self.part {
                Part::Message(message) => {
                    let layout = &self.walk.messages[message];
                    let Some(field) = entries.next_key_seed(FieldName(layout))? else { return Ok(()) };
                    if field.is_none() && self.walk.language == Language::Rust {
                        entries.next_value::<IgnoredAny>()?;
                        continue;
                    }
                    self.walk.add(if is_next { PLACE } else { NODE });
                    match field {
                        Some(index) => {
                            let field = &layout.fields[index];
                            let part = self.walk.part(field.kind);
                            Value { walk: self.walk, part, cost: field.cost, is_next: false }
                        }
                        None => self.inside(Part::Unknown),
                    }
                }
                Part::Map(entry) => {
                    if entries.next_key::<IgnoredAny>()?.is_none() {
                        return Ok(());
                    }
                    self.walk.add(if is_next { ENTRY } else { NODE });
                    self.walk.add(if is_next { self.cost.next } else { self.cost.first });
                    let value = self.walk.messages[entry].field(2);
                    let part = value.map_or(Part::Plain, |field| self.walk.part(field.kind));
                    let cost = value.map_or(Cost { first: 0, next: 0 }, |field| field.cost);
                    Value { walk: self.walk, part, cost, is_next: false }
                }
                part => {
                    if entries.next_key::<IgnoredAny>()?.is_none() {
                        return Ok(());
                    }
                    self.walk.add(if is_next { ENTRY } else { NODE });
                    self.inside(part)
                }
            };
            entries.next_value_seed(value)?;
            is_next = true;
        }
    }
}

impl Value<'_> {
    fn inside(&self, part: Part) -> Self {
        Self { walk: self.walk, part, cost: Cost { first: 0, next: 0 }, is_next: false }
    }
}

/// The index of the field with this name.
struct FieldName<'m>(&'m MessageLayout);

impl<'de> DeserializeSeed<'de> for FieldName<'_> {
    type Value = Option<usize>;

    fn deserialize<D: Deserializer<'de>>(self, input: D) -> Result<Option<usize>, D::Error> {
        input.deserialize_str(self)
    }
}

impl Visitor<'_> for FieldName<'_> {
    type Value = Option<usize>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a name")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Option<usize>, E> {
        Ok(self.0.by_name.get(name).copied())
    }
}
