//! The C++ names that protoc gives to the messages of the schemas.

use crate::clash::{Declaration, Origin};
use crate::system::{MessageUse, System};
use prost_types::{DescriptorProto, FileDescriptorProto};
use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::UNWRITABLE_NAME;
use scl_topology::keywords::CPP;
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
            for_each_message(file, &mut |path, _message| {
                let scope: String = package(file).iter().map(|part| format!("::{part}")).collect();
                let cpp_type = format!("{scope}::{}", class_name(path));
                messages.insert(dotted(file, path), Message { cpp_type, header: header(file.name()) });
            });
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

/// The names that the headers of the schemas declare where they could meet those of the system's header: beside its
/// components, and beside its namespace.
pub(super) fn declarations(system: &System, namespace: &str, inside: &str) -> Vec<Declaration> {
    let outside = "the global C++ namespace";
    let mut found = vec![Declaration {
        scope: outside.to_owned(),
        name: namespace.to_owned(),
        origin: Origin::generated(format!("namespace `{namespace}`")),
    }];
    for file in files(system) {
        let package = package(file);
        let scope = match package.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
            [] => outside,
            [only] if *only == namespace => inside,
            [first, second, ..] if *first == namespace => {
                let origin = Origin::generated(format!("package `{}`", file.package()));
                found.push(Declaration { scope: inside.to_owned(), name: (*second).to_owned(), origin });
                continue;
            }
            _ => continue,
        };
        let mut declare = |name: String, origin| found.push(Declaration { scope: scope.to_owned(), name, origin });
        for_each_message(file, &mut |path, message| {
            let dotted = dotted(file, path);
            declare(class_name(path), origin(system, &dotted));
            for inner in &message.enum_type {
                let path = [path, &[inner.name()]].concat();
                declare(class_name(&path), Origin::other_message(&dotted));
            }
        });
        for outer in &file.enum_type {
            let name = protoc_identifier(outer.name());
            declare(name, Origin::generated(format!("enum `{}`", dotted_name(file, outer.name()))));
            for value in &outer.value {
                let origin = Origin::generated(format!("enum value `{}`", dotted_name(file, value.name())));
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

/// Calls a function with the names of each message from the outermost, and the message. Entries of maps are left out.
fn for_each_message<'f>(file: &'f FileDescriptorProto, call: &mut dyn FnMut(&[&'f str], &'f DescriptorProto)) {
    fn visit<'f>(
        path: &mut Vec<&'f str>,
        message: &'f DescriptorProto,
        call: &mut dyn FnMut(&[&'f str], &'f DescriptorProto),
    ) {
        path.push(message.name());
        call(path, message);
        let is_entry = |inner: &&DescriptorProto| inner.options.as_ref().is_some_and(|options| options.map_entry());
        message.nested_type.iter().filter(|inner| !is_entry(inner)).for_each(|inner| visit(path, inner, call));
        path.pop();
    }
    file.message_type.iter().for_each(|message| visit(&mut Vec::new(), message, call));
}

fn package(file: &FileDescriptorProto) -> Vec<String> {
    file.package().split('.').filter(|part| !part.is_empty()).map(str::to_owned).collect()
}

fn dotted(file: &FileDescriptorProto, path: &[&str]) -> String {
    dotted_name(file, &path.join("."))
}

fn dotted_name(file: &FileDescriptorProto, name: &str) -> String {
    if file.package().is_empty() { name.to_owned() } else { format!("{}.{name}", file.package()) }
}

/// A nested message is a class beside the outer one, named by both.
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

/// A name as protoc writes it. It knows no macros but `NULL`.
fn protoc_identifier(name: &str) -> String {
    let is_escaped = name == "NULL" || CPP.contains(&name) && !ESCAPED_BY_SOME.contains(&name);
    if is_escaped { format!("{name}_") } else { name.to_owned() }
}

/// SCL1103: messages of gates whose C++ name depends on the version of protoc, or is none because protoc does not
/// escape packages.
pub(super) fn unwritable(system: &System) -> Vec<Diagnostic> {
    let mut told = HashSet::new();
    let gates = system.components.iter().flat_map(|component| &component.gates);
    let used = gates.flat_map(|gate| &gate.types).filter(|used| used.in_schemas && told.insert(used.dotted.as_str()));
    used.filter_map(|used| {
        let (package, path) = files(system).find_map(|file| Some((package(file), path_in(file, &used.dotted)?)))?;
        let is_reserved = |part: &&String| part.as_str() == "NULL" || CPP.contains(&part.as_str());
        let message = &used.dotted;
        let headline = if let Some(part) = package.iter().find(is_reserved) {
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

/// The name of a message in its file, if it declares it.
fn path_in(file: &FileDescriptorProto, message: &str) -> Option<String> {
    let mut found = None;
    for_each_message(file, &mut |path, _| {
        if dotted(file, path) == message {
            found = Some(path.join("_"));
        }
    });
    found
}

fn header(proto: &str) -> String {
    format!("{}.pb.h", proto.strip_suffix(".proto").unwrap_or(proto))
}
