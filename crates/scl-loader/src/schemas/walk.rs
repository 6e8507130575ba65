//! Walks through what schema files declare.

use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto};

// Field numbers of `FileDescriptorProto`, `DescriptorProto` and `EnumDescriptorProto`, as they appear in the paths of
// `google.protobuf.SourceCodeInfo`.
pub(super) const FILE_PACKAGE: i32 = 2;
/// `FileDescriptorProto.message_type`.
pub const FILE_MESSAGE: i32 = 4;
/// `FileDescriptorProto.enum_type`.
pub const FILE_ENUM: i32 = 5;
/// `DescriptorProto.field`.
pub const MESSAGE_FIELD: i32 = 2;
/// `DescriptorProto.nested_type`.
pub const MESSAGE_NESTED: i32 = 3;
/// `DescriptorProto.enum_type`.
pub const MESSAGE_ENUM: i32 = 4;
pub(super) const MESSAGE_ONEOF: i32 = 8;
/// `EnumDescriptorProto.value`.
pub const ENUM_VALUE: i32 = 2;
pub(super) const NAME: i32 = 1;

/// The messages of a file at any depth, each after the one that declares it, with the names from the outermost to its
/// own. Entries of maps are among them, see [`is_map_entry`].
pub fn messages(file: &FileDescriptorProto) -> Vec<(Vec<&str>, &DescriptorProto)> {
    let mut found = Vec::new();
    let mut open: Vec<(Vec<&str>, &DescriptorProto)> =
        file.message_type.iter().rev().map(|message| (vec![message.name()], message)).collect();
    while let Some((path, message)) = open.pop() {
        let nested = message.nested_type.iter().rev();
        open.extend(nested.map(|nested| ([path.as_slice(), &[nested.name()]].concat(), nested)));
        found.push((path, message));
    }
    found
}

/// The full name of a declaration of a file: `rover.v1.ImuData.Axis`.
pub fn full_name(file: &FileDescriptorProto, path: &[&str]) -> String {
    dotted(file.package(), &path.join("."))
}

/// Joins an outer name and a name with a dot; returns the name alone if the outer one is empty.
pub(super) fn dotted(outer: &str, name: &str) -> String {
    if outer.is_empty() { name.to_owned() } else { format!("{outer}.{name}") }
}

/// Returns the entry type of a map field, which is nested in the field's message; `None` for other fields.
pub fn map_entry<'m>(message: &'m DescriptorProto, field: &FieldDescriptorProto) -> Option<&'m DescriptorProto> {
    let name = field.type_name().rsplit('.').next()?;
    message.nested_type.iter().find(|nested| is_map_entry(nested) && nested.name() == name)
}

/// Whether a message stands for the entries of a map, and is no type of its own.
pub fn is_map_entry(message: &DescriptorProto) -> bool {
    message.options.as_ref().is_some_and(|options| options.map_entry())
}
