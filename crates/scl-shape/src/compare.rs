//! Comparing the shapes of protobuf messages: whether two programs mean the same by the same bytes.
//!
//! Fields and enum values may be added and removed, as protobuf promises. A number that both programs use must have the
//! same name and type in both, and a name that both use must have the same number: a renumbered field would arrive as
//! its default value, without an error.

use crate::declared::{Index, Item};
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, EnumDescriptorProto, FieldDescriptorProto, FileDescriptorSet};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::fmt;

/// More differences than this are not looked for.
const MOST: usize = 100;

/// How fields are told apart in the bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// By their numbers: protobuf.
    Numbers,
    /// By their names: canonical JSON.
    Names,
}

impl Encoding {
    /// The encoding of a codec by its word in the topology file; `None` if it does not carry messages of schemas.
    pub fn of_codec(codec: &str) -> Option<Self> {
        match codec {
            "protobuf" => Some(Self::Numbers),
            "json" => Some(Self::Names),
            _ => None,
        }
    }
}

/// What differs between the messages of two programs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// The full name of the message or enum.
    pub name: String,
    /// The part that differs.
    pub what: What,
    /// In the first program: `` `lat` (double)``, or a number.
    pub here: String,
    /// In the second program.
    pub there: String,
}

/// A part of a message or enum.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum What {
    /// The field with this number.
    Field(i32),
    /// The number of the field with this name.
    NumberOfField(String),
    /// The names of the enum value with this number.
    Value(i32),
    /// The number of the enum value with this name.
    NumberOfValue(String),
}

impl Difference {
    /// The whole text; `peer` is the peer's name.
    pub fn text(&self, peer: &str) -> String {
        format!("{} {} here, but {} in {peer}", self.subject(), self.here, self.there)
    }

    /// ``message `nav.Position`: field 1 is``
    fn subject(&self) -> String {
        let name = &self.name;
        match &self.what {
            What::Field(number) => format!("message `{name}`: field {number} is"),
            What::NumberOfField(field) => format!("message `{name}`: field `{field}` has number"),
            What::Value(number) => format!("enum `{name}`: value {number} is"),
            What::NumberOfValue(value) => format!("enum `{name}`: value `{value}` has number"),
        }
    }
}

/// Compares a message, or the two of a call (`A -> B`), and all messages and enums in it. Those that only one program
/// knows are not compared.
///
/// # Errors
/// The first difference.
pub fn compare(
    payload: &str,
    encoding: Encoding,
    here: &FileDescriptorSet,
    there: &FileDescriptorSet,
) -> Result<(), Difference> {
    match differences(payload, encoding, here, there).into_iter().next() {
        Some(difference) => Err(difference),
        None => Ok(()),
    }
}

/// As [`compare`], but all differences, at most a hundred.
pub fn differences(
    payload: &str,
    encoding: Encoding,
    here: &FileDescriptorSet,
    there: &FileDescriptorSet,
) -> Vec<Difference> {
    let (here, there) = (Index::of(here), Index::of(there));
    let mut found = Vec::new();
    let mut names: Vec<&str> = payload.split("->").map(str::trim).collect();
    let mut seen: HashSet<&str> = names.iter().copied().collect();
    while let Some(name) = names.pop().filter(|_| found.len() < MOST) {
        match (here.find(name), there.find(name)) {
            (Some(Item::Message(ours)), Some(Item::Message(theirs))) => {
                let (ours, theirs) = (fields(ours, &here), fields(theirs, &there));
                compare_fields(name, encoding, &ours, &theirs, &mut found);
                let shared = ours.into_iter().filter(|(number, _)| theirs.contains_key(number));
                names.extend(shared.filter_map(|(_, field)| field.named).filter(|name| seen.insert(name)));
            }
            (Some(Item::Enum(ours)), Some(Item::Enum(theirs))) => {
                compare_values(name, encoding, ours, theirs, &mut found)
            }
            _ => {}
        }
    }
    found.truncate(MOST);
    found
}

/// The properties of a field that must be the same in both programs.
#[derive(PartialEq, Eq)]
struct Field<'d> {
    name: &'d str,
    kind: Kind<'d>,
    oneof: Option<&'d str>,
    /// The message or enum to compare next.
    named: Option<&'d str>,
}

#[derive(PartialEq, Eq)]
enum Kind<'d> {
    Single(Plain<'d>),
    Repeated(Plain<'d>),
    Map(Plain<'d>, Plain<'d>),
}

/// A scalar type, or the kind and name of another.
#[derive(PartialEq, Eq)]
struct Plain<'d>(Type, &'d str);

fn fields<'d>(message: &'d DescriptorProto, index: &Index<'d>) -> BTreeMap<i32, Field<'d>> {
    let field = |field: &'d FieldDescriptorProto| {
        let number = field.number();
        let named = field.type_name.as_deref().map(without_dot);
        let field = Field { name: field.name(), kind: kind(field, index), oneof: oneof(field, message), named };
        (number, field)
    };
    message.field.iter().map(field).collect()
}

fn kind<'d>(field: &'d FieldDescriptorProto, index: &Index<'d>) -> Kind<'d> {
    let plain = |field: &'d FieldDescriptorProto| Plain(field.r#type(), without_dot(field.type_name()));
    if field.label() != Label::Repeated {
        return Kind::Single(plain(field));
    }
    match index.find(without_dot(field.type_name())) {
        Some(Item::Message(entry)) if entry.options.as_ref().is_some_and(|options| options.map_entry()) => {
            match entry.field.as_slice() {
                [key, value] => Kind::Map(plain(key), plain(value)),
                _ => Kind::Repeated(plain(field)),
            }
        }
        _ => Kind::Repeated(plain(field)),
    }
}

/// Returns the oneof of a field. The synthetic oneof of an `optional` field in proto3 does not count: it makes no
/// difference on the wire.
fn oneof<'d>(field: &FieldDescriptorProto, message: &'d DescriptorProto) -> Option<&'d str> {
    let index = field.oneof_index.filter(|_| !field.proto3_optional())?;
    Some(message.oneof_decl.get(usize::try_from(index).ok()?)?.name())
}

fn compare_fields(
    message: &str,
    encoding: Encoding,
    here: &BTreeMap<i32, Field<'_>>,
    there: &BTreeMap<i32, Field<'_>>,
    found: &mut Vec<Difference>,
) {
    let by_name: HashMap<&str, (i32, &Field<'_>)> =
        there.iter().map(|(&at, field)| (field.name, (at, field))).collect();
    for (number, ours) in here {
        // In JSON, compare with the field of the same name, if there is one.
        let named = by_name.get(ours.name).filter(|_| encoding == Encoding::Names).map(|(_, field)| *field);
        if let Some(theirs) = named.or_else(|| there.get(number)).filter(|theirs| *theirs != ours) {
            let what = What::Field(*number);
            found.push(Difference {
                name: message.to_owned(),
                what,
                here: ours.to_string(),
                there: theirs.to_string(),
            });
        }
    }
    if encoding == Encoding::Names {
        return;
    }
    for (number, Field { name, .. }) in here {
        // A number that belongs to another field was reported above.
        if let Some((other, _)) = by_name.get(name).filter(|(other, _)| other != number)
            && !there.contains_key(number)
        {
            let what = What::NumberOfField((*name).to_owned());
            found.push(Difference {
                name: message.to_owned(),
                what,
                here: number.to_string(),
                there: other.to_string(),
            });
        }
    }
}

/// Compares the values of an enum. With `allow_alias`, one number may have several names; one that both programs know
/// is enough.
fn compare_values(
    name: &str,
    encoding: Encoding,
    here: &EnumDescriptorProto,
    there: &EnumDescriptorProto,
    found: &mut Vec<Difference>,
) {
    let (ours, theirs) = (names(here), names(there));
    let mut push = |what, here, there| found.push(Difference { name: name.to_owned(), what, here, there });
    for (number, our_names) in &ours {
        let Some(their_names) = theirs.get(number) else { continue };
        let known = || there.value.iter().any(|value| our_names.contains(value.name()));
        if our_names.is_disjoint(their_names) && !(encoding == Encoding::Names && known()) {
            let text =
                |names: &BTreeSet<&str>| format!("`{}`", names.first().map(|name| shown(name)).unwrap_or_default());
            push(What::Value(*number), text(our_names), text(their_names));
        }
    }
    if encoding == Encoding::Names {
        return;
    }
    let numbers: HashMap<&str, i32> = there.value.iter().map(|value| (value.name(), value.number())).collect();
    for value in &here.value {
        if let Some(other) = numbers.get(value.name()).filter(|other| **other != value.number())
            && !theirs.contains_key(&value.number())
        {
            push(What::NumberOfValue(value.name().to_owned()), value.number().to_string(), other.to_string());
        }
    }
}

fn names(values: &EnumDescriptorProto) -> BTreeMap<i32, BTreeSet<&str>> {
    let mut names: BTreeMap<i32, BTreeSet<&str>> = BTreeMap::new();
    for value in &values.value {
        names.entry(value.number()).or_default().insert(value.name());
    }
    names
}

/// Displayed as in ``field 1 is `tags` (map<string, nav.Tag>)``.
impl fmt::Display for Field<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` (", shown(self.name))?;
        match &self.kind {
            Kind::Single(plain) => write!(f, "{plain}")?,
            Kind::Repeated(plain) => write!(f, "repeated {plain}")?,
            Kind::Map(key, value) => write!(f, "map<{key}, {value}>")?,
        }
        match self.oneof {
            Some(oneof) => write!(f, " in oneof `{}`)", shown(oneof)),
            None => f.write_str(")"),
        }
    }
}

impl fmt::Display for Plain<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(kind, name) = self;
        match kind {
            Type::Message => f.write_str(&shown(name)),
            Type::Enum => write!(f, "enum {}", shown(name)),
            Type::Group => write!(f, "group {}", shown(name)),
            scalar => f.write_str(&scalar.as_str_name().trim_start_matches("TYPE_").to_ascii_lowercase()),
        }
    }
}

/// Shortens a name and escapes its control characters: the descriptors may come from a stranger's program.
fn shown(name: &str) -> String {
    const LONGEST: usize = 200;
    let mut shown: String = name.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if name.chars().nth(LONGEST).is_some() {
        shown.push('…');
    }
    shown
}

fn without_dot(name: &str) -> &str {
    name.strip_prefix('.').unwrap_or(name)
}

#[cfg(test)]
mod tests;
