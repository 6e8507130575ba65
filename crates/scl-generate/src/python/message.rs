//! Messages and enums, as type checkers see them and as the program makes them.

mod field;
mod methods;

use super::layout::{Doc, Layout};
use super::names::{self, Names};
use super::schema::{
    ENUM_VALUE, FILE_ENUM, FILE_MESSAGE, MESSAGE_ENUM, MESSAGE_FIELD, MESSAGE_NESTED, Path, Schema, SchemaFile,
};
use super::{Imports, docs};
use crate::identifier;
use crate::writer::Writer;
use field::Field;
use prost_types::{DescriptorProto, EnumDescriptorProto};

/// Everything that the classes of messages are made from.
pub(super) struct Messages<'a> {
    pub(super) schema: &'a Schema<'a>,
    pub(super) names: &'a Names,
    pub(super) imports: &'a Imports,
}

/// A message or enum that is being written.
#[derive(Clone, Copy)]
struct Scope<'a> {
    file: &'a SchemaFile<'a>,
    /// With a dot at its start.
    full_name: &'a str,
    path: &'a Path,
    /// In levels of indentation.
    depth: usize,
}

impl Messages<'_> {
    /// Writes the declarations, and the function that makes the classes.
    pub(super) fn write(&self, out: &mut Writer) {
        if self.names.top_level().next().is_none() {
            return;
        }
        out.line("\n\nif TYPE_CHECKING:");
        out.indented(|out| {
            if !self.names.enums().is_empty() || self.has_nested_enums() {
                out.blank();
                methods::write_enum_base(self, out);
            }
            for file in self.schema.own_files() {
                for (index, declared) in file.file.enum_type.iter().enumerate() {
                    let path = vec![FILE_ENUM, index_of(index)];
                    let full_name = file.full_name(declared.name());
                    out.blank();
                    self.write_enum(declared, Scope { file, full_name: &full_name, path: &path, depth: 1 }, out);
                }
                for (index, message) in file.file.message_type.iter().enumerate() {
                    let path = vec![FILE_MESSAGE, index_of(index)];
                    let full_name = file.full_name(message.name());
                    out.blank();
                    self.write_message(message, Scope { file, full_name: &full_name, path: &path, depth: 1 }, out);
                }
            }
            for (at, (alias, name)) in self.names.aliases().enumerate() {
                if at == 0 {
                    out.blank();
                }
                out.line(format!("{alias} = {name}"));
            }
        });
        out.line("else:");
        out.indented(|out| {
            let table = |names: &std::collections::BTreeMap<String, String>| {
                let rows = names.iter().map(|(name, full_name)| Doc::text(format!("\"{name}\": \"{full_name}\"")));
                Doc::group("{", rows.collect(), "}")
            };
            let arguments = vec![
                Doc::text("__name__"),
                Doc::text("_PLAN"),
                table(self.names.messages()),
                table(self.names.enums()),
            ];
            let call = [Doc::text("__getattr__ = _scl.codec.lazy_messages"), Doc::group("(", arguments, ")")];
            out.line(Layout::at(1).print(&Doc::concat(call)));
        });
    }

    fn has_nested_enums(&self) -> bool {
        fn has(message: &DescriptorProto) -> bool {
            !message.enum_type.is_empty() || message.nested_type.iter().any(has)
        }
        self.schema.own_files().any(|file| file.file.message_type.iter().any(has))
    }

    fn write_message(&self, message: &DescriptorProto, scope: Scope<'_>, out: &mut Writer) {
        out.line(format!("@{}", self.imports.of("typing", "final")));
        let base = self.imports.of("google.protobuf.message", "Message");
        out.line(format!("class {}({base}):", self.class_name(message.name(), scope)));
        out.indented(|out| {
            let mut is_first = true;
            if let Some(comment) = scope.file.comment(scope.path) {
                docs::write(comment, out);
                is_first = false;
            }
            let depth = scope.depth + 1;
            for (index, nested) in message.nested_type.iter().enumerate() {
                if nested.options.as_ref().is_some_and(|options| options.map_entry()) {
                    continue;
                }
                let path = with(scope.path, MESSAGE_NESTED, index);
                let full_name = format!("{}.{}", scope.full_name, nested.name());
                separate(&mut is_first, out);
                self.write_message(nested, Scope { full_name: &full_name, path: &path, depth, ..scope }, out);
            }
            for (index, declared) in message.enum_type.iter().enumerate() {
                let path = with(scope.path, MESSAGE_ENUM, index);
                let full_name = format!("{}.{}", scope.full_name, declared.name());
                separate(&mut is_first, out);
                self.write_enum(declared, Scope { full_name: &full_name, path: &path, depth, ..scope }, out);
                // The class has the values, too, as C++ and Java have.
                out.blank();
                self.write_values(declared, &full_name, &path, scope.file, out);
            }
            let fields: Vec<Field<'_>> =
                message.field.iter().map(|field| Field::of(self, message, field, scope)).collect();
            for (index, field) in fields.iter().enumerate() {
                let comment = scope.file.comment(&with(scope.path, MESSAGE_FIELD, index));
                field.write(self, comment, &mut is_first, out);
            }
            methods::write(self, message, &fields, scope, &mut is_first, out);
        });
    }

    fn write_enum(&self, declared: &EnumDescriptorProto, scope: Scope<'_>, out: &mut Writer) {
        out.line(format!("class {}(_Enum):", self.class_name(declared.name(), scope)));
        out.indented(|out| {
            if let Some(comment) = scope.file.comment(scope.path) {
                docs::write(comment, out);
                out.blank();
            }
            self.write_values(declared, scope.full_name, scope.path, scope.file, out);
            if !declared.value.iter().any(|value| names::is_value_attribute(value.name())) {
                out.line("pass");
            }
        });
    }

    fn write_values(
        &self,
        declared: &EnumDescriptorProto,
        full_name: &str,
        path: &Path,
        file: &SchemaFile<'_>,
        out: &mut Writer,
    ) {
        let class_var = self.imports.of("typing", "ClassVar");
        let reference = self.names.reference(full_name, self.imports);
        for (index, value) in declared.value.iter().enumerate() {
            if !names::is_value_attribute(value.name()) {
                // Reached by `getattr` or `Value` only.
                out.line(format!("# {}: no attribute of Python", value.name()));
                continue;
            }
            out.line(format!("{}: {class_var}[{reference}]", value.name()));
            if let Some(comment) = file.comment(&with(path, ENUM_VALUE, index)) {
                docs::write(comment, out);
            }
        }
    }

    fn class_name(&self, name: &str, scope: Scope<'_>) -> String {
        match scope.depth {
            1 => self.names.top_level_name(scope.full_name).to_owned(),
            _ => identifier::python(name),
        }
    }
}

fn with(path: &Path, field: i32, index: usize) -> Path {
    let mut path = path.clone();
    path.extend([field, index_of(index)]);
    path
}

fn index_of(index: usize) -> i32 {
    i32::try_from(index).unwrap_or(i32::MAX)
}

/// An empty line, except at the start of a block.
fn separate(is_first: &mut bool, out: &mut Writer) {
    if !std::mem::take(is_first) {
        out.blank();
    }
}
