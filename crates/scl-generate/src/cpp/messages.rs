//! The C++ names that protoc gives to the messages of the schemas.

use crate::clash::{Declaration, Origin};
use crate::system::{MessageUse, System};
use prost_types::{DescriptorProto, FileDescriptorProto};
use scl_loader::walk::{full_name, is_map_entry, messages};
use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::UNWRITABLE_NAME;
use scl_topology::keywords::is_cpp;
use std::collections::{BTreeSet, HashMap, HashSet};

/// The messages of the schemas by their dotted names.
pub(super) struct Messages(HashMap<String, Message>);

struct Message {
    /// `::rover::Measurement`.
    cpp_type: String,
    /// `rover.pb.h`.
    header: String,
}

impl Messages {
    pub(super) fn of(system: &System) -> Self {
        let mut messages = HashMap::new();
        for file in files(system) {
            let scope: String = package(file).map(|part| format!("::{part}")).collect();
            messages.extend(types(file).map(|(path, _)| {
                let cpp_type = format!("{scope}::{}", class_name(&path));
                (full_name(file, &path), Message { cpp_type, header: header(file.name()) })
            }));
        }
        Self(messages)
    }

    pub(super) fn cpp_type(&self, dotted: &str) -> Option<&str> {
        self.0.get(dotted).map(|message| message.cpp_type.as_str())
    }

    /// The headers that declare these types, sorted.
    pub(super) fn headers<'m>(&self, used: impl Iterator<Item = &'m MessageUse>) -> BTreeSet<&str> {
        used.filter_map(|used| self.0.get(&used.dotted)).map(|message| message.header.as_str()).collect()
    }
}

/// The names that the headers of the schemas declare where they could clash with those of the system's header: in the
/// namespace of its components, and in the global namespace.
pub(super) fn declarations(system: &System, namespace: &str, inside: &str) -> Vec<Declaration> {
    let outside = "the global C++ namespace";
    let origin_of_system = Origin::generated(format!("namespace `{namespace}`"));
    let mut found = vec![Declaration::new(outside, namespace, origin_of_system)];
    for file in files(system) {
        let scope = match package(file).collect::<Vec<_>>().as_slice() {
            [] => outside,
            [only] if *only == namespace => inside,
            [first, second, ..] if *first == namespace => {
                let origin = Origin::generated(format!("package `{}`", file.package()));
                found.push(Declaration::new(inside, *second, origin));
                continue;
            }
            _ => continue,
        };
        let mut declare = |name: String, origin| found.push(Declaration::new(scope, name, origin));
        for (path, message) in types(file) {
            let dotted = full_name(file, &path);
            declare(class_name(&path), origin(system, &dotted));
            for inner in &message.enum_type {
                let path = [path.as_slice(), &[inner.name()]].concat();
                declare(class_name(&path), Origin::other_message(&dotted));
            }
        }
        for outer in &file.enum_type {
            let name = protoc_identifier(outer.name());
            declare(name, Origin::generated(format!("enum `{}`", full_name(file, &[outer.name()]))));
            for value in &outer.value {
                let origin = Origin::generated(format!("enum value `{}`", full_name(file, &[value.name()])));
                declare(protoc_identifier(value.name()), origin);
            }
        }
    }
    found
}

/// A message, with its place in the topology file if a gate carries it.
fn origin(system: &System, dotted: &str) -> Origin {
    let mut used = system.components.iter().flat_map(|component| &component.gates).flat_map(|gate| &gate.types);
    used.find(|used| used.in_schemas && used.dotted == dotted)
        .map_or_else(|| Origin::other_message(dotted), Origin::message)
}

fn files(system: &System) -> impl Iterator<Item = &FileDescriptorProto> {
    system.descriptors.iter().flat_map(|set| &set.file)
}

/// The messages of a file without the entries of maps.
fn types(file: &FileDescriptorProto) -> impl Iterator<Item = (Vec<&str>, &DescriptorProto)> {
    messages(file).into_iter().filter(|(_, message)| !is_map_entry(message))
}

fn package(file: &FileDescriptorProto) -> impl Iterator<Item = &str> {
    file.package().split('.').filter(|part| !part.is_empty())
}

/// The class of a message. The class of a nested message is declared beside the outer one, and its name contains both
/// names.
fn class_name(path: &[&str]) -> String {
    protoc_identifier(&path.join("_"))
}

/// The keywords that only some versions of protoc escape.
const ESCAPED_BY_SOME: [&str; 10] = [
    "char8_t",
    "char16_t",
    "char32_t",
    "co_await",
    "co_return",
    "co_yield",
    "concept",
    "consteval",
    "constinit",
    "requires",
];

/// A name as protoc writes it: keywords are escaped, and of all macros only `NULL`.
fn protoc_identifier(name: &str) -> String {
    let is_escaped = name == "NULL" || is_cpp(name) && !ESCAPED_BY_SOME.contains(&name);
    if is_escaped { format!("{name}_") } else { name.to_owned() }
}

/// SCL1103: messages of gates whose C++ name depends on the version of protoc, or is invalid because protoc does not
/// escape packages.
pub(crate) fn unwritable(system: &System) -> Vec<Diagnostic> {
    let mut told = HashSet::new();
    let gates = system.components.iter().flat_map(|component| &component.gates);
    let used = gates.flat_map(|gate| &gate.types).filter(|used| used.in_schemas && told.insert(used.dotted.as_str()));
    used.filter_map(|used| {
        let message = &used.dotted;
        let found = files(system).flat_map(|file| types(file).map(move |(path, _)| (file, path)));
        let (file, path) = found.into_iter().find(|(file, path)| full_name(file, path) == *message)?;
        let path = path.join("_");
        let is_reserved = |part: &&str| *part == "NULL" || is_cpp(part);
        let headline = if let Some(part) = package(file).find(is_reserved) {
            format!("`{part}` in the package of `{message}` is reserved in C++, and protoc does not escape it there")
        } else if ESCAPED_BY_SOME.contains(&path.as_str()) {
            format!(
                "the message `{message}` is `{path}` in C++ with some versions of protoc, and `{path}_` with others"
            )
        } else {
            return None;
        };
        Some(UNWRITABLE_NAME.at(headline, used.span, "carried by a gate").help("rename it in the schema"))
    })
    .collect()
}

fn header(proto: &str) -> String {
    format!("{}.pb.h", proto.strip_suffix(".proto").unwrap_or(proto))
}
