//! A field: its type when it is read, and when it is given to the constructor.

use super::{Messages, Scope, separate};
use crate::python::{docs, names};
use crate::writer::Writer;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto};
use scl_loader::walk::map_entry;

/// A field with its types.
pub(super) struct Field<'a> {
    pub(super) name: &'a str,
    /// The type when it is read.
    read: String,
    /// The type that the constructor takes.
    pub(super) given: String,
    /// Whether it is changed in place, as messages, lists and maps are; assigning them is an error in protobuf.
    is_changed_in_place: bool,
    /// Whether `HasField` accepts it.
    pub(super) has_presence: bool,
    /// The index of its `oneof`.
    pub(super) oneof: Option<usize>,
}

impl<'a> Field<'a> {
    pub(super) fn of(
        messages: &Messages<'_>,
        message: &DescriptorProto,
        field: &'a FieldDescriptorProto,
        scope: &Scope<'_>,
    ) -> Self {
        let is_message = matches!(field.r#type(), Type::Message | Type::Group);
        let is_repeated = field.label() == Label::Repeated;
        let imports = messages.imports;
        let containers = "google.protobuf.internal.containers";
        let (read, given) = if let Some(entry) = map_entry(message, field) {
            let element = |at: usize| entry.field.get(at).map(|it| type_of(messages, it)).unwrap_or_default();
            let (key, value) = (element(0), element(1));
            let is_message = entry.field.get(1).is_some_and(|it| it.r#type() == Type::Message);
            let class = imports.of(containers, if is_message { "MessageMap" } else { "ScalarMap" });
            let mapping = imports.of("collections.abc", "Mapping");
            (format!("{class}[{key}, {value}]"), format!("{mapping}[{key}, {value}]"))
        } else if is_repeated {
            let element = type_of(messages, field);
            let name = if is_message { "RepeatedCompositeFieldContainer" } else { "RepeatedScalarFieldContainer" };
            let (class, iterable) = (imports.of(containers, name), imports.of("collections.abc", "Iterable"));
            (format!("{class}[{element}]"), format!("{iterable}[{element}]"))
        } else {
            let value = type_of(messages, field);
            (value.clone(), value)
        };
        let oneof = field.oneof_index.filter(|_| !field.proto3_optional());
        let is_explicit = oneof.is_some() || field.proto3_optional() || scope.file.has_implicit_presence();
        Self {
            name: field.name(),
            read,
            given,
            is_changed_in_place: is_message || is_repeated,
            has_presence: !is_repeated && (is_message || is_explicit),
            oneof: oneof.and_then(|index| usize::try_from(index).ok()),
        }
    }

    pub(super) fn write(&self, messages: &Messages<'_>, comment: Option<&str>, is_first: &mut bool, out: &mut Writer) {
        separate(is_first, out);
        if !names::is_attribute(self.name) {
            out.line(format!("# {0}: not usable as an attribute name; use `getattr(message, \"{0}\")`", self.name));
        } else if self.is_changed_in_place {
            out.line(format!("@{}", messages.names.builtin("property", messages.imports)));
            match comment {
                None => out.line(format!("def {}(self) -> {}: ...", self.name, self.read)),
                Some(comment) => {
                    out.line(format!("def {}(self) -> {}:", self.name, self.read));
                    out.indented(|out| {
                        docs::write(comment, out);
                        // With only a docstring, type checkers report a missing return.
                        out.line("...");
                    });
                }
            }
        } else {
            out.line(format!("{}: {}", self.name, self.read));
            if let Some(comment) = comment {
                docs::write(comment, out);
            }
        }
    }
}

fn type_of(messages: &Messages<'_>, field: &FieldDescriptorProto) -> String {
    let builtin = |name| messages.names.builtin(name, messages.imports);
    match field.r#type() {
        Type::Double | Type::Float => builtin("float"),
        Type::Int64
        | Type::Uint64
        | Type::Int32
        | Type::Fixed64
        | Type::Fixed32
        | Type::Uint32
        | Type::Sfixed32
        | Type::Sfixed64
        | Type::Sint32
        | Type::Sint64 => builtin("int"),
        Type::Bool => builtin("bool"),
        Type::String => builtin("str"),
        Type::Bytes => builtin("bytes"),
        Type::Group | Type::Message | Type::Enum => messages.names.reference(field.type_name(), messages.imports),
    }
}
