//! Every name that prost's generator writes for the schemas, with the scope that it must be unique in.

use super::names::{snake_case, upper_camel_case, variant};
use super::paths::package_parts;
use crate::schemas::walk::{
    ENUM_VALUE, FILE_ENUM, FILE_MESSAGE, FILE_PACKAGE, MESSAGE_ENUM, MESSAGE_FIELD, MESSAGE_NESTED, MESSAGE_ONEOF,
    NAME, dotted, is_map_entry, map_entry,
};
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, EnumDescriptorProto, FieldDescriptorProto, FileDescriptorProto};
use scl_topology::model::Model;
use scl_topology::rust_name::component_type;
use scl_topology::source::Span;
use std::collections::HashSet;

/// A generated Rust name.
#[derive(Debug)]
pub(super) struct Declared<'f> {
    /// What the name belongs to, as messages say it: ``in the Rust module `rover::status` ``.
    pub(super) scope: String,
    /// The identifier, perhaps raw; empty if there is none.
    pub(super) name: String,
    /// What it stands for, as messages say it: ``message `rover.Status` ``.
    pub(super) what: String,
    /// Where the declaration is written.
    pub(super) origin: Origin<'f>,
}

/// Where a declaration is written.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Origin<'f> {
    /// In a schema file, at a path as in `google.protobuf.SourceCodeInfo`.
    Schema { file: &'f str, path: Vec<i32> },
    /// In the topology file.
    Topology(Span),
}

/// The scope of the components, and of what is generated beside them.
const ROOT: &str = "in the module that calls the macro";

/// The components, and the counterparts that the macro generates beside them.
pub(super) fn of_components(model: &Model) -> impl Iterator<Item = Declared<'static>> {
    model.components.iter().flat_map(|component| {
        let what = format!("component `{}`", component.name.value);
        let name = component_type(&component.name.value);
        let peer = (format!("{name}Peer"), format!("the counterpart of {what}"));
        let origin = Origin::Topology(component.name.span);
        [(name, what), peer].map(|(name, what)| Declared { scope: ROOT.to_owned(), name, what, origin: origin.clone() })
    })
}

/// Returns the names that are generated from one schema file.
pub(super) fn of_schema(file: &FileDescriptorProto) -> Vec<Declared<'_>> {
    let is_proto3 = file.syntax() == "proto3";
    let mut walk = Walk { file: file.name(), is_proto3, path: Vec::new(), modules: Vec::new(), found: Vec::new() };
    let mut package = String::new();
    for part in package_parts(file.package()) {
        package = dotted(&package, part);
        // Packages with the same module name share the module, so they do not clash.
        let module = snake_case(part);
        walk.add(walk.module(), &module, format!("package `{package}`"), vec![FILE_PACKAGE]);
        walk.modules.push(module);
    }
    walk.inside(FILE_MESSAGE, &file.message_type, |walk, message| walk.message(file.package(), message));
    walk.inside(FILE_ENUM, &file.enum_type, |walk, declared| walk.enumeration(file.package(), declared));
    walk.found
}

struct Walk<'f> {
    file: &'f str,
    is_proto3: bool,
    path: Vec<i32>,
    modules: Vec<String>,
    found: Vec<Declared<'f>>,
}

impl<'f> Walk<'f> {
    fn module(&self) -> String {
        if self.modules.is_empty() {
            ROOT.to_owned()
        } else {
            format!("in the Rust module `{}`", self.modules.join("::"))
        }
    }

    /// The full Rust name of a type of this module.
    fn type_path(&self, name: &str) -> String {
        self.modules.iter().map(|module| format!("{module}::")).collect::<String>() + name
    }

    fn add(&mut self, scope: String, name: &str, what: String, path: Vec<i32>) {
        let origin = Origin::Schema { file: self.file, path };
        self.found.push(Declared { scope, name: name.to_owned(), what, origin });
    }

    /// Adds a name for the declaration at the current path.
    fn add_here(&mut self, scope: String, name: &str, what: String) {
        let path = [self.path.as_slice(), &[NAME]].concat();
        self.add(scope, name, what, path);
    }

    /// Visits the declarations in a list field of the current one; `list` is the number of that field.
    fn inside<T>(&mut self, list: i32, all: &'f [T], mut visit: impl FnMut(&mut Self, &'f T)) {
        for (index, one) in all.iter().enumerate() {
            self.path.extend([list, index as i32]);
            visit(self, one);
            self.path.truncate(self.path.len() - 2);
        }
    }

    fn message(&mut self, outer: &str, message: &'f DescriptorProto) {
        let full = dotted(outer, message.name());
        let what = format!("message `{full}`");
        let name = upper_camel_case(message.name());
        self.add_here(self.module(), &name, what.clone());
        let oneofs = real_oneofs(message);
        let scope = format!("in the Rust struct `{}`", self.type_path(&name));
        self.inside(MESSAGE_FIELD, &message.field, |walk, field| walk.field(&scope, &full, message, field));
        self.inside(MESSAGE_ONEOF, &message.oneof_decl, |walk, oneof| {
            if oneofs.contains(oneof.name()) {
                let what = format!("oneof `{}`", dotted(&full, oneof.name()));
                walk.add_here(scope.clone(), &snake_case(oneof.name()), what);
            }
        });
        let has_nested = message.nested_type.iter().any(|nested| !is_map_entry(nested));
        if oneofs.is_empty() && !has_nested && message.enum_type.is_empty() {
            return;
        }
        let module = snake_case(message.name());
        self.add_here(self.module(), &module, format!("the module of {what}"));
        self.modules.push(module);
        self.inside(MESSAGE_NESTED, &message.nested_type, |walk, nested| {
            if !is_map_entry(nested) {
                walk.message(&full, nested);
            }
        });
        self.inside(MESSAGE_ENUM, &message.enum_type, |walk, declared| walk.enumeration(&full, declared));
        self.inside(MESSAGE_ONEOF, &message.oneof_decl, |walk, oneof| {
            if oneofs.contains(oneof.name()) {
                let name = oneof_type(message, oneof.name());
                walk.add_here(walk.module(), &name, format!("oneof `{}`", dotted(&full, oneof.name())));
            }
        });
        self.modules.pop();
    }

    /// A field of the struct, with its methods, or a variant of a oneof.
    fn field(&mut self, scope: &str, message: &str, of: &'f DescriptorProto, field: &'f FieldDescriptorProto) {
        let what = format!("field `{}`", dotted(message, field.name()));
        if let Some(oneof) = oneof_of(of, field) {
            let module = self.type_path(&snake_case(of.name()));
            let scope = format!("in the Rust enum `{module}::{}`", oneof_type(of, oneof));
            self.add_here(scope, &upper_camel_case(field.name()), what);
            return;
        }
        let name = snake_case(field.name());
        for method in methods(of, field, &name, self.is_proto3) {
            self.add_here(scope.replacen("in", "among the methods of", 1), &method, what.clone());
        }
        self.add_here(scope.to_owned(), &name, what);
    }

    fn enumeration(&mut self, outer: &str, declared: &'f EnumDescriptorProto) {
        let name = upper_camel_case(declared.name());
        self.add_here(self.module(), &name, format!("enum `{}`", dotted(outer, declared.name())));
        let scope = format!("in the Rust enum `{}`", self.type_path(&name));
        let mut numbers = HashSet::new();
        self.inside(ENUM_VALUE, &declared.value, |walk, value| {
            // An alias of an earlier value gets no variant.
            if numbers.insert(value.number()) {
                let what = format!("enum value `{}`", dotted(outer, value.name()));
                walk.add_here(scope.clone(), &variant(&name, value.name()), what);
            }
        });
    }
}

/// Returns the oneofs that the file declares, without the synthetic ones of `optional` fields.
fn real_oneofs(message: &DescriptorProto) -> HashSet<&str> {
    message.field.iter().filter_map(|field| oneof_of(message, field)).collect()
}

fn oneof_of<'f>(message: &'f DescriptorProto, field: &FieldDescriptorProto) -> Option<&'f str> {
    let index = field.oneof_index.filter(|_| !field.proto3_optional())?;
    message.oneof_decl.get(usize::try_from(index).ok()?).map(|oneof| oneof.name())
}

/// Returns the type of a oneof. prost appends `OneOf` if a nested message or enum has the same name.
fn oneof_type(message: &DescriptorProto, oneof: &str) -> String {
    let name = upper_camel_case(oneof);
    let nested = message.nested_type.iter().map(DescriptorProto::name);
    let mut nested = nested.chain(message.enum_type.iter().map(EnumDescriptorProto::name));
    let is_taken = nested.any(|nested| upper_camel_case(nested) == name);
    if is_taken { format!("{name}OneOf") } else { name }
}

/// The methods that prost's derive macro adds for a field.
fn methods(message: &DescriptorProto, field: &FieldDescriptorProto, name: &str, is_proto3: bool) -> Vec<String> {
    let plain = name.trim_start_matches("r#");
    if let Some(entry) = map_entry(message, field) {
        let has_enum = entry.field.iter().any(|field| field.name() == "value" && field.r#type() == Type::Enum);
        // Not `plain`: the derive macro keeps the `r#` here.
        return if has_enum { vec![format!("get_{name}"), format!("insert_{name}")] } else { Vec::new() };
    }
    match (field.r#type(), field.label()) {
        (Type::Enum, Label::Repeated) => vec![name.to_owned(), format!("push_{plain}")],
        (Type::Enum, _) => vec![name.to_owned(), format!("set_{plain}")],
        (Type::Message | Type::Group, _) | (_, Label::Repeated) => Vec::new(),
        // Only fields that may be unset have a getter.
        (_, Label::Optional) if field.proto3_optional() || !is_proto3 => vec![name.to_owned()],
        _ => Vec::new(),
    }
}
