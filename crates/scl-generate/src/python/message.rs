//! Messages and enums, as type checkers see them and as the program makes them.

mod field;
mod methods;

use super::layout::{Doc, Layout};
use super::names::{self, Names};
use super::schema::{Path, Schema, SchemaFile};
use super::{Imports, docs};
use crate::identifier;
use crate::writer::Writer;
use field::Field;
use prost_types::{DescriptorProto, EnumDescriptorProto};
use scl_loader::walk::{
    ENUM_VALUE, FILE_ENUM, FILE_MESSAGE, MESSAGE_ENUM, MESSAGE_FIELD, MESSAGE_NESTED, is_map_entry, messages,
};

/// Everything that the classes of messages are made from.
pub(super) struct Messages<'a> {
    pub(super) schema: &'a Schema<'a>,
    pub(super) names: &'a Names,
    pub(super) imports: &'a Imports,
}

/// A message or enum that is being written, or the file around them.
struct Scope<'a> {
    file: &'a SchemaFile<'a>,
    /// With a dot at its start; empty for the file.
    full_name: String,
    path: Path,
    /// In levels of indentation.
    depth: usize,
}

impl Scope<'_> {
    /// The scope of a declaration inside this one, at `index` in the list with the field number `list`.
    fn inner(&self, name: &str, list: i32, index: usize) -> Self {
        let full_name = match self.depth {
            0 => self.file.full_name(name),
            _ => format!("{}.{name}", self.full_name),
        };
        Self { file: self.file, full_name, path: with(&self.path, list, index), depth: self.depth + 1 }
    }
}

impl Messages<'_> {
    /// Writes the declarations, and the function that makes the classes.
    pub(super) fn write(&self, out: &mut Writer) {
        if self.names.top_level().next().is_none() {
            return;
        }
        out.line("\n\nif TYPE_CHECKING:");
        out.indented(|out| {
            let has_enums = |message: &DescriptorProto| !message.enum_type.is_empty();
            let mut files = self.schema.own_files();
            let has_inner = files.any(|file| messages(file.file).iter().any(|(_, message)| has_enums(message)));
            if !self.names.enums.is_empty() || has_inner {
                out.blank();
                methods::write_enum_base(self, out);
            }
            for file in self.schema.own_files() {
                let top = Scope { file, full_name: String::new(), path: Path::new(), depth: 0 };
                for (index, declared) in file.file.enum_type.iter().enumerate() {
                    out.blank();
                    self.write_enum(declared, &top.inner(declared.name(), FILE_ENUM, index), out);
                }
                for (index, message) in file.file.message_type.iter().enumerate() {
                    out.blank();
                    self.write_message(message, &top.inner(message.name(), FILE_MESSAGE, index), out);
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
            let arguments =
                vec![Doc::text("__name__"), Doc::text("_PLAN"), table(&self.names.messages), table(&self.names.enums)];
            let call = [Doc::text("__getattr__ = _scl.codec.lazy_messages"), Doc::group("(", arguments, ")")];
            out.line(Layout::at(1).print(&Doc::concat(call)));
        });
    }

    fn write_message(&self, message: &DescriptorProto, scope: &Scope<'_>, out: &mut Writer) {
        out.line(format!("@{}", self.imports.of("typing", "final")));
        let base = self.imports.of("google.protobuf.message", "Message");
        out.line(format!("class {}({base}):", self.class_name(message.name(), scope)));
        out.indented(|out| {
            let mut is_first = true;
            if let Some(comment) = scope.file.comment(&scope.path) {
                docs::write(comment, out);
                is_first = false;
            }
            let nested = message.nested_type.iter().enumerate();
            for (index, nested) in nested.filter(|(_, nested)| !is_map_entry(nested)) {
                separate(&mut is_first, out);
                self.write_message(nested, &scope.inner(nested.name(), MESSAGE_NESTED, index), out);
            }
            for (index, declared) in message.enum_type.iter().enumerate() {
                let inner = scope.inner(declared.name(), MESSAGE_ENUM, index);
                separate(&mut is_first, out);
                self.write_enum(declared, &inner, out);
                // The enclosing class has the enum's values, too, as in C++ and Java.
                out.blank();
                self.write_values(declared, &inner, out);
            }
            let fields: Vec<Field<'_>> =
                message.field.iter().map(|field| Field::of(self, message, field, scope)).collect();
            for (index, field) in fields.iter().enumerate() {
                let comment = scope.file.comment(&with(&scope.path, MESSAGE_FIELD, index));
                field.write(self, comment, &mut is_first, out);
            }
            methods::write(self, message, &fields, scope, &mut is_first, out);
        });
    }

    fn write_enum(&self, declared: &EnumDescriptorProto, scope: &Scope<'_>, out: &mut Writer) {
        out.line(format!("class {}(_Enum):", self.class_name(declared.name(), scope)));
        out.indented(|out| {
            if let Some(comment) = scope.file.comment(&scope.path) {
                docs::write(comment, out);
                out.blank();
            }
            self.write_values(declared, scope, out);
            if !declared.value.iter().any(|value| names::is_value_attribute(value.name())) {
                out.line("pass");
            }
        });
    }

    fn write_values(&self, declared: &EnumDescriptorProto, scope: &Scope<'_>, out: &mut Writer) {
        let class_var = self.imports.of("typing", "ClassVar");
        let reference = self.names.reference(&scope.full_name, self.imports);
        for (index, value) in declared.value.iter().enumerate() {
            if !names::is_value_attribute(value.name()) {
                // Only reachable through `getattr` or `Value`.
                out.line(format!("# {}: not usable as an attribute name", value.name()));
                continue;
            }
            out.line(format!("{}: {class_var}[{reference}]", value.name()));
            if let Some(comment) = scope.file.comment(&with(&scope.path, ENUM_VALUE, index)) {
                docs::write(comment, out);
            }
        }
    }

    fn class_name(&self, name: &str, scope: &Scope<'_>) -> String {
        match scope.depth {
            1 => self.names.top_level_name(&scope.full_name).to_owned(),
            _ => identifier::python(name),
        }
    }
}

fn with(path: &Path, field: i32, index: usize) -> Path {
    let mut path = path.clone();
    path.extend([field, i32::try_from(index).unwrap_or(i32::MAX)]);
    path
}

/// Writes an empty line, except at the start of a block.
fn separate(is_first: &mut bool, out: &mut Writer) {
    if !std::mem::take(is_first) {
        out.blank();
    }
}
