//! What a decoded message and its fields take.

use super::Language;
use crate::declared::{self, is_message, type_name};
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorSet};
use std::collections::{HashMap, HashSet};

/// What a message takes besides its fields: its header in libprotobuf or `protobuf-c`, or discriminants of oneofs and
/// padding in Rust.
const HEADER: u64 = 32;
/// What an allocator adds to a block.
const BLOCK: u64 = 16;
/// A `String` or `Vec` of Rust, or a `RepeatedField` of C++.
const CONTAINER: u64 = 24;
/// `Bytes` of Rust, or a text of C++.
const TEXT: u64 = 32;
/// A `HashMap` of Rust.
const HASH_MAP: u64 = 48;
/// A `MapField` of C++.
const MAP_FIELD: u64 = 112;

/// A message type.
#[derive(Debug, Clone)]
pub(super) struct MessageLayout {
    pub(super) size: u64,
    /// Sorted by number.
    pub(super) fields: Vec<Field>,
    /// Indices of fields by their names, and by those in JSON.
    pub(super) by_name: HashMap<String, usize>,
    /// Whether canonical JSON has a special form for it.
    pub(super) is_well_known: bool,
}

#[derive(Debug, Clone)]
pub(super) struct Field {
    pub(super) number: u32,
    pub(super) kind: Kind,
    pub(super) cost: Cost,
}

/// The memory that each occurrence of a field adds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cost {
    /// The first in a row: a `Vec` starts with room for 4, a map with room for 11.
    pub(super) first: u64,
    /// Each further one: a list may have twice the capacity that it needs, and while a map grows, its smaller
    /// predecessor still exists.
    pub(super) next: u64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Message(usize),
    /// A map, by the index of its entry type; the map's value is a field of the entry.
    Map(usize),
    Text,
    /// A number of `width` bytes in memory, and of `packed` bytes in a packed field; `packed` is 0 if that varies.
    Number {
        width: u64,
        packed: usize,
    },
}

impl MessageLayout {
    pub(super) fn field(&self, number: u32) -> Option<&Field> {
        self.fields.binary_search_by_key(&number, |field| field.number).ok().map(|index| &self.fields[index])
    }
}

/// The layouts of a type and of those that it contains, itself first.
pub(super) fn of(files: &FileDescriptorSet, name: &str, language: Language) -> Option<Vec<MessageLayout>> {
    let (names, types): (Vec<_>, Vec<_>) = declared::reachable(files, name)?.into_iter().unzip();
    let mut sizes = Sizes::new(&names, &types, language);
    let layouts = (0..names.len()).map(|index| {
        let mut declared: Vec<&FieldDescriptorProto> = types[index].field.iter().collect();
        declared.sort_by_key(|field| field.number());
        let named = declared.iter().enumerate();
        let by_name = named.flat_map(|(at, field)| [field.name(), field.json_name()].map(|name| (name.to_owned(), at)));
        MessageLayout {
            size: sizes.of(index),
            by_name: by_name.collect(),
            fields: declared.iter().map(|field| sizes.field(index, field)).collect(),
            is_well_known: names[index].starts_with("google.protobuf."),
        }
    });
    Some(layouts.collect())
}

struct Sizes<'d> {
    types: &'d [&'d DescriptorProto],
    indices: HashMap<&'d str, usize>,
    /// The types that each type can contain at any depth.
    reached: Vec<HashSet<usize>>,
    language: Language,
    known: HashMap<usize, u64>,
}

impl<'d> Sizes<'d> {
    fn new(names: &[&'d str], types: &'d [&'d DescriptorProto], language: Language) -> Self {
        let indices: HashMap<&str, usize> = names.iter().enumerate().map(|(index, name)| (*name, index)).collect();
        let inner = |index: usize| {
            let fields = types[index].field.iter().filter(|field| is_message(field));
            fields.map(|field| indices[type_name(field)]).collect::<Vec<_>>()
        };
        let contained: Vec<Vec<usize>> = (0..types.len()).map(inner).collect();
        let reached = (0..types.len()).map(|index| reached(index, &contained)).collect();
        Self { types, indices, reached, language, known: HashMap::new() }
    }

    fn of(&mut self, message: usize) -> u64 {
        if let Some(size) = self.known.get(&message) {
            return *size;
        }
        let mut size = HEADER;
        let mut choices: HashMap<i32, u64> = HashMap::new();
        for field in &self.types[message].field {
            let own = self.in_place(message, field);
            match field.oneof_index {
                Some(choice) => {
                    let largest = choices.entry(choice).or_default();
                    *largest = own.max(*largest);
                }
                None => size = size.saturating_add(own),
            }
        }
        let size = choices.values().fold(size, |size, largest| size.saturating_add(*largest));
        self.known.insert(message, size);
        size
    }

    /// What a field takes in its message.
    fn in_place(&mut self, message: usize, field: &FieldDescriptorProto) -> u64 {
        match field.r#type() {
            Type::Message if self.is_entry(self.indices[type_name(field)]) => match self.language {
                Language::Rust => HASH_MAP,
                Language::Other => MAP_FIELD,
            },
            _ if field.label() == Label::Repeated => CONTAINER,
            Type::Message | Type::Group => {
                let inner = self.indices[type_name(field)];
                if self.is_inline(message, inner) { self.of(inner).saturating_add(8) } else { 8 }
            }
            Type::String | Type::Bytes => TEXT,
            _ => 16,
        }
    }

    /// Whether `message` contains `inner` in place: only in Rust, and only if `inner` cannot contain `message` in turn.
    /// In Rust, a map entry always does, because it is not itself stored in a message.
    fn is_inline(&self, message: usize, inner: usize) -> bool {
        self.language == Language::Rust && (self.is_entry(message) || !self.reached[inner].contains(&message))
    }

    fn is_entry(&self, message: usize) -> bool {
        self.types[message].options.as_ref().is_some_and(|options| options.map_entry())
    }

    fn field(&mut self, message: usize, field: &FieldDescriptorProto) -> Field {
        let repeated = field.label() == Label::Repeated;
        let kind = match field.r#type() {
            Type::Message | Type::Group => {
                let inner = self.indices[type_name(field)];
                if self.is_entry(inner) { Kind::Map(inner) } else { Kind::Message(inner) }
            }
            Type::String | Type::Bytes => Kind::Text,
            Type::Bool => Kind::Number { width: 1, packed: 0 },
            Type::Double | Type::Fixed64 | Type::Sfixed64 => Kind::Number { width: 8, packed: 8 },
            Type::Float | Type::Fixed32 | Type::Sfixed32 => Kind::Number { width: 4, packed: 4 },
            Type::Int64 | Type::Uint64 | Type::Sint64 => Kind::Number { width: 8, packed: 0 },
            Type::Int32 | Type::Uint32 | Type::Sint32 | Type::Enum => Kind::Number { width: 4, packed: 0 },
        };
        let cost = match kind {
            Kind::Map(entry) => times(self.of(entry).saturating_add(BLOCK), [11, 5]),
            Kind::Message(inner) if repeated => match self.language {
                Language::Rust => times(self.of(inner), [4, 2]),
                // One block per element, and an array of pointers.
                Language::Other => times(self.of(inner).saturating_add(BLOCK + 32), [1, 1]),
            },
            Kind::Message(inner) if self.is_inline(message, inner) => times(0, [0, 0]),
            Kind::Message(inner) => times(self.of(inner).saturating_add(BLOCK), [1, 1]),
            Kind::Text if repeated => times(TEXT, [4, 2]),
            // C++ and C allocate both the text object and its content.
            Kind::Text => times(BLOCK + TEXT, [1, 1]),
            Kind::Number { width, .. } if repeated => Cost { first: (8 * width).max(32), next: 2 * width },
            Kind::Number { .. } => times(0, [0, 0]),
        };
        Field { number: field.number().unsigned_abs(), kind, cost }
    }
}

/// `start` and what it contains at any depth.
fn reached(start: usize, contained: &[Vec<usize>]) -> HashSet<usize> {
    let (mut seen, mut next) = (HashSet::new(), vec![start]);
    while let Some(at) = next.pop() {
        if seen.insert(at) {
            next.extend(&contained[at]);
        }
    }
    seen
}

fn times(size: u64, [first, next]: [u64; 2]) -> Cost {
    Cost { first: size.saturating_mul(first), next: size.saturating_mul(next) }
}
