//! The names of a generated module: what components, gates and messages are called in Python.

use super::Imports;
use super::schema::{Schema, SchemaFile};
use crate::identifier;
use crate::system::{ChoiceValue, Component, Gate, Parameter, System};
use scl_loader::walk;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Names that the module has besides components and messages.
pub(super) const OWN: &[&str] = &["TYPE_CHECKING", "annotations", "_PLAN", "_scl", "_Enum"];

/// Attributes that every component has: gates of these names get a trailing underscore. The package has the same rule,
/// and a test compares the two.
pub(super) const OF_COMPONENTS: &[&str] = &[
    "close",
    "fileno",
    "gates",
    "name",
    "parameters_changed",
    "ready",
    "ready_async",
    "set_parameter",
    "system",
    "update_parameters",
    "wait",
];

/// Names of `google.protobuf.message.Message`: fields of these names are reached by `getattr` only.
const OF_MESSAGES: &str = "ByteSize Clear ClearExtension ClearField CopyFrom DESCRIPTOR DiscardUnknownFields \
                           Extensions FindInitializationErrors FromString HasExtension HasField IsInitialized \
                           ListFields MergeFrom MergeFromString ParseFromString RegisterExtension \
                           SerializePartialToString SerializeToString SetInParent UnknownFields WhichOneof";

/// Names that every Python module has without an import.
const PYTHON_BUILTINS: &str = "ArithmeticError AssertionError AttributeError BaseException BaseExceptionGroup \
                               BlockingIOError BrokenPipeError BufferError BytesWarning ChildProcessError \
                               ConnectionAbortedError ConnectionError ConnectionRefusedError ConnectionResetError \
                               DeprecationWarning EOFError Ellipsis EncodingWarning EnvironmentError Exception \
                               ExceptionGroup FileExistsError FileNotFoundError FloatingPointError FutureWarning \
                               GeneratorExit IOError ImportError ImportWarning IndentationError IndexError \
                               InterruptedError IsADirectoryError KeyError KeyboardInterrupt LookupError MemoryError \
                               ModuleNotFoundError NameError NotADirectoryError NotImplemented NotImplementedError \
                               OSError OverflowError PendingDeprecationWarning PermissionError ProcessLookupError \
                               RecursionError ReferenceError ResourceWarning RuntimeError RuntimeWarning \
                               StopAsyncIteration StopIteration SyntaxError SyntaxWarning SystemError SystemExit \
                               TabError TimeoutError TypeError UnboundLocalError UnicodeDecodeError UnicodeEncodeError \
                               UnicodeError UnicodeTranslateError UnicodeWarning UserWarning ValueError Warning \
                               ZeroDivisionError abs aiter all anext any ascii bin bool breakpoint bytearray bytes \
                               callable chr classmethod compile complex delattr dict dir divmod enumerate eval exec \
                               filter float format frozenset getattr globals hasattr hash help hex id input int \
                               isinstance issubclass iter len list locals map max memoryview min next object oct open \
                               ord pow print property range repr reversed round set setattr slice sorted staticmethod \
                               str sum super tuple type vars zip";

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
        // Names with a leading underscore belong to the class itself, and Python mangles those with two.
        format!("gate{name}")
    } else {
        name
    }
}

/// The field of a parameter.
pub(super) fn parameter(parameter: &Parameter) -> String {
    let name = identifier::python(&parameter.snake_name);
    // As for gates. The package has the same rule.
    if name.starts_with('_') { format!("parameter{name}") } else { name }
}

/// The member of an enum for a word that a parameter can be.
pub(super) fn choice(value: &ChoiceValue) -> String {
    value.snake_name.to_ascii_uppercase()
}

/// Whether a field can be written as an attribute.
pub(super) fn is_attribute(field: &str) -> bool {
    // Inside classes, Python mangles names that start with two underscores.
    identifier::python(field) == field && !has_word(OF_MESSAGES, field) && !field.starts_with("__")
}

/// Methods of enums: values of these names are reached by `Value` only.
const OF_ENUMS: &[&str] = &["Name", "Value", "items", "keys", "values"];

/// Whether a value of an enum can be written as an attribute, of the enum and of the message that declares it.
pub(super) fn is_value_attribute(value: &str) -> bool {
    is_attribute(value) && !OF_ENUMS.contains(&value)
}

/// The names of messages and enums.
pub(super) struct Names {
    /// Messages and enums at any depth, by full name with a leading dot.
    types: HashMap<String, TypeName>,
    /// Names of top-level messages and enums in the module, with their full names without a leading dot.
    pub(super) messages: BTreeMap<String, String>,
    pub(super) enums: BTreeMap<String, String>,
    /// Attributes of classes, which hide names of the module inside the class.
    attributes: BTreeSet<String>,
}

struct TypeName {
    /// `Everything.Inner`, or for well-known types `timestamp_pb2.Timestamp`.
    path: String,
    is_well_known: bool,
}

impl Names {
    pub(super) fn of(system: &System, schema: &Schema<'_>) -> Self {
        let parameters = system.components.iter().flat_map(|component| &component.parameters);
        let mut names = Self {
            types: HashMap::new(),
            messages: BTreeMap::new(),
            enums: BTreeMap::new(),
            attributes: system.gates().map(gate).chain(parameters.map(parameter)).collect(),
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
        let mut add = |path: &[&str], top_level: &mut BTreeMap<String, String>| {
            let Some((first, inner)) = path.split_first() else { return };
            let name = in_module(first);
            let full_name = file.full_name(&path.join("."));
            if inner.is_empty() && !is_well_known {
                top_level.insert(name.clone(), full_name[1..].to_owned());
            }
            let path = inner.iter().fold(name, |path, inner| format!("{path}.{}", identifier::python(inner)));
            self.types.insert(full_name, TypeName { path, is_well_known });
        };
        file.file.enum_type.iter().for_each(|declared| add(&[declared.name()], &mut self.enums));
        for (path, message) in walk::messages(file.file) {
            add(&path, &mut self.messages);
            for declared in &message.enum_type {
                add(&[path.as_slice(), &[declared.name()]].concat(), &mut self.enums);
            }
            if !is_well_known {
                let values = message.enum_type.iter().flat_map(|declared| &declared.value).map(|value| value.name());
                let enums = message.enum_type.iter().map(|declared| declared.name());
                let nested = message.nested_type.iter().map(|nested| nested.name());
                let fields = message.field.iter().map(|field| field.name());
                let names = fields.chain(nested).chain(enums).chain(values);
                self.attributes.extend(names.map(str::to_owned));
            }
        }
    }

    /// The messages and enums of the module, with their full names.
    pub(super) fn top_level(&self) -> impl Iterator<Item = (&str, &str)> {
        self.messages.iter().chain(&self.enums).map(|(name, full_name)| (name.as_str(), full_name.as_str()))
    }

    /// The name of a top-level message or enum; `full_name` starts with a dot.
    pub(super) fn top_level_name(&self, full_name: &str) -> &str {
        self.types.get(full_name).map_or("", |found| found.path.as_str())
    }

    /// A message or enum in an annotation; `full_name` starts with a dot.
    pub(super) fn reference(&self, full_name: &str, imports: &Imports) -> String {
        // Every reference was resolved when the schemas were compiled.
        let Some(found) = self.types.get(full_name) else { return imports.of("typing", "Any") };
        let head = found.path.split('.').next().unwrap_or_default();
        let shown = match found.is_well_known {
            true => imports.of("google.protobuf", head),
            false if self.is_hidden(head) => alias(head),
            false => head.to_owned(),
        };
        shown + &found.path[head.len()..]
    }

    /// Whether an annotation with this name in a class would mean something else: an attribute of the class, or a
    /// builtin of Python, which mypy takes for a name that the module declares further down.
    fn is_hidden(&self, name: &str) -> bool {
        self.attributes.contains(name) || has_word(PYTHON_BUILTINS, name)
    }

    /// The aliases by which annotations reach hidden names of the module, with these names.
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

fn has_word(words: &str, name: &str) -> bool {
    words.split(' ').any(|word| word == name)
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

#[cfg(test)]
mod tests {
    use super::{OF_MESSAGES, PYTHON_BUILTINS};

    #[test]
    fn names_are_listed_once() {
        for words in [OF_MESSAGES, PYTHON_BUILTINS] {
            let mut sorted: Vec<&str> = words.split(' ').collect();
            sorted.sort_unstable();
            sorted.dedup();
            assert_eq!(sorted.len(), words.split(' ').count());
        }
    }
}
