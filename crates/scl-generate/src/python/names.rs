//! The names of a generated module: what components, gates and messages are called in Python.

use super::Imports;
use super::schema::{Schema, SchemaFile};
use crate::identifier;
use crate::system::{Component, Gate, System};
use prost_types::DescriptorProto;
use scl_topology::keywords::PYTHON_BUILTINS;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Names that the module has besides components and messages.
pub(super) const OWN: &[&str] = &["TYPE_CHECKING", "annotations", "_PLAN", "_scl", "_Enum"];

/// What every component has: gates of these names get a trailing underscore. The package has the same rule, and a test
/// compares the two.
pub(super) const OF_COMPONENTS: &[&str] =
    &["close", "fileno", "gates", "name", "ready", "ready_async", "system", "wait"];

/// Names of `google.protobuf.message.Message`: fields of these names are reached by `getattr` only.
const OF_MESSAGES: &[&str] = &[
    "ByteSize",
    "Clear",
    "ClearExtension",
    "ClearField",
    "CopyFrom",
    "DESCRIPTOR",
    "DiscardUnknownFields",
    "Extensions",
    "FindInitializationErrors",
    "FromString",
    "HasExtension",
    "HasField",
    "IsInitialized",
    "ListFields",
    "MergeFrom",
    "MergeFromString",
    "ParseFromString",
    "RegisterExtension",
    "SerializePartialToString",
    "SerializeToString",
    "SetInParent",
    "UnknownFields",
    "WhichOneof",
];

/// Names of `builtins` that annotations use.
const BUILTINS: &[&str] = &["bool", "bytes", "classmethod", "float", "int", "list", "property", "str", "tuple"];

/// The class of a component.
pub(super) fn class(component: &Component) -> String {
    identifier::python(&component.class_name)
}

/// The attribute of a gate.
pub(super) fn gate(gate: &Gate) -> String {
    let name = identifier::python(&gate.snake_name);
    if OF_COMPONENTS.contains(&name.as_str()) {
        format!("{name}_")
    } else if name.starts_with('_') {
        // Such names belong to the class itself, and Python rewrites those that start with two.
        format!("gate{name}")
    } else {
        name
    }
}

/// Whether a field can be written as an attribute.
pub(super) fn is_attribute(field: &str) -> bool {
    // Python rewrites names that start with two underscores inside of classes.
    identifier::python(field) == field && !OF_MESSAGES.contains(&field) && !field.starts_with("__")
}

/// Methods of enums: values of these names are reached by `Value` only.
const OF_ENUMS: &[&str] = &["Name", "Value", "items", "keys", "values"];

/// Whether a value of an enum can be written as an attribute, of the enum and of the message that declares it.
pub(super) fn is_value_attribute(value: &str) -> bool {
    is_attribute(value) && !OF_ENUMS.contains(&value)
}

/// The names of messages and enums.
pub(super) struct Names {
    /// By full name with a dot at its start, of messages and enums at any depth.
    types: HashMap<String, TypeName>,
    /// Names in the module, with their full names without a dot at the start.
    messages: BTreeMap<String, String>,
    enums: BTreeMap<String, String>,
    /// Attributes of classes, which hide names of the module inside of the class.
    attributes: BTreeSet<String>,
}

#[derive(Clone)]
struct TypeName {
    /// `Everything.Inner`, or of well-known types `timestamp_pb2.Timestamp`.
    path: String,
    is_well_known: bool,
}

impl Names {
    pub(super) fn of(system: &System, schema: &Schema<'_>) -> Self {
        let mut names = Self {
            types: HashMap::new(),
            messages: BTreeMap::new(),
            enums: BTreeMap::new(),
            attributes: system.gates().map(gate).collect(),
        };
        let ambiguous = ambiguous_names(schema);
        for file in &schema.files {
            names.add_file(file, &ambiguous);
        }
        names
    }

    fn add_file(&mut self, file: &SchemaFile<'_>, ambiguous: &HashSet<&str>) {
        let is_well_known = file.is_well_known();
        let in_module = |name: &str| {
            if is_well_known {
                let module = file.file.name().trim_start_matches("google/protobuf/").trim_end_matches(".proto");
                return format!("{}_pb2.{name}", module.replace('/', "."));
            }
            let package = file.file.package().replace('.', "_");
            if ambiguous.contains(name) && !package.is_empty() {
                return format!("{package}_{name}");
            }
            identifier::python(name)
        };
        for message in &file.file.message_type {
            let (path, full_name) = (in_module(message.name()), file.full_name(message.name()));
            if !is_well_known {
                self.messages.insert(path.clone(), full_name[1..].to_owned());
            }
            self.add_message(message, &full_name, path, is_well_known);
        }
        for declared in &file.file.enum_type {
            let (path, full_name) = (in_module(declared.name()), file.full_name(declared.name()));
            if !is_well_known {
                self.enums.insert(path.clone(), full_name[1..].to_owned());
            }
            self.types.insert(full_name, TypeName { path, is_well_known });
        }
    }

    fn add_message(&mut self, message: &DescriptorProto, full_name: &str, path: String, is_well_known: bool) {
        for nested in &message.nested_type {
            let inner = format!("{path}.{}", identifier::python(nested.name()));
            self.add_message(nested, &format!("{full_name}.{}", nested.name()), inner, is_well_known);
        }
        for declared in &message.enum_type {
            let inner = format!("{path}.{}", identifier::python(declared.name()));
            self.types.insert(format!("{full_name}.{}", declared.name()), TypeName { path: inner, is_well_known });
            if !is_well_known {
                self.attributes.insert(declared.name().to_owned());
                self.attributes.extend(declared.value.iter().map(|value| value.name().to_owned()));
            }
        }
        if !is_well_known {
            self.attributes.extend(message.field.iter().map(|field| field.name().to_owned()));
            self.attributes.extend(message.nested_type.iter().map(|nested| nested.name().to_owned()));
        }
        self.types.insert(full_name.to_owned(), TypeName { path, is_well_known });
    }

    /// The messages and enums of the module, with their full names.
    pub(super) fn top_level(&self) -> impl Iterator<Item = (&str, &str)> {
        self.messages.iter().chain(&self.enums).map(|(name, full_name)| (name.as_str(), full_name.as_str()))
    }

    pub(super) fn messages(&self) -> &BTreeMap<String, String> {
        &self.messages
    }

    pub(super) fn enums(&self) -> &BTreeMap<String, String> {
        &self.enums
    }

    /// The name of a top-level message or enum; `full_name` starts with a dot.
    pub(super) fn top_level_name(&self, full_name: &str) -> &str {
        self.types.get(full_name).map_or("", |found| found.path.as_str())
    }

    /// A message or enum in an annotation; `full_name` starts with a dot.
    pub(super) fn reference(&self, full_name: &str, imports: &Imports) -> String {
        // Every reference was resolved when the schemas were compiled.
        let Some(found) = self.types.get(full_name) else { return imports.of("typing", "Any") };
        if found.is_well_known {
            let module = found.path.split('.').next().unwrap_or_default();
            return format!("{}{}", imports.of("google.protobuf", module), &found.path[module.len()..]);
        }
        let head = found.path.split('.').next().unwrap_or_default();
        if self.is_hidden(head) { format!("{}{}", alias(head), &found.path[head.len()..]) } else { found.path.clone() }
    }

    /// Whether an annotation in a class would mean something else: an attribute of the class, or what Python has
    /// itself, which mypy takes for a name that the module declares further down.
    fn is_hidden(&self, name: &str) -> bool {
        self.attributes.contains(name) || PYTHON_BUILTINS.contains(&name)
    }

    /// Hidden names of the module, and the name by which annotations reach them.
    pub(super) fn aliases(&self) -> impl Iterator<Item = (String, &str)> {
        let hidden = self.top_level().map(|(name, _)| name).filter(|name| self.is_hidden(name));
        hidden.map(|name| (alias(name), name))
    }

    /// A name of `builtins` in an annotation.
    pub(super) fn builtin(&self, name: &'static str, imports: &Imports) -> String {
        let is_hidden = |it: &str| self.attributes.contains(it) || self.top_level().any(|(name, _)| name == it);
        if BUILTINS.iter().any(|it| is_hidden(it)) {
            format!("{}.{name}", imports.of("", "builtins"))
        } else {
            name.to_owned()
        }
    }
}

fn alias(name: &str) -> String {
    format!("_type_{name}")
}

/// Names that more than one package declares.
fn ambiguous_names<'s>(schema: &Schema<'s>) -> HashSet<&'s str> {
    let mut seen = HashSet::new();
    let files = schema.own_files().map(|file| file.file);
    let names = files.flat_map(|file| {
        let messages = file.message_type.iter().map(|it| it.name());
        messages.chain(file.enum_type.iter().map(|it| it.name()))
    });
    names.filter(|name| !seen.insert(*name)).collect()
}
