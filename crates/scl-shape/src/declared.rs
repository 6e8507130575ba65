//! The message types that a type contains.

use prost_types::field_descriptor_proto::Type;
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorSet};
use std::collections::HashMap;

/// A type and those that it contains at any depth, itself first; `None` if the files do not declare one of them.
pub(crate) fn reachable<'d>(
    files: &'d FileDescriptorSet,
    name: &'d str,
) -> Option<Vec<(&'d str, &'d DescriptorProto)>> {
    let mut declared = HashMap::new();
    for file in &files.file {
        declare(file.package(), &file.message_type, &mut declared);
    }
    let mut names = vec![name];
    let mut types = Vec::new();
    while let Some(name) = names.get(types.len()).copied() {
        let message: &'d DescriptorProto = declared.get(name)?;
        for field in message.field.iter().filter(|field| is_message(field)) {
            let inner = type_name(field);
            if !names.contains(&inner) {
                names.push(inner);
            }
        }
        types.push((name, message));
    }
    Some(types)
}

pub(crate) fn is_message(field: &FieldDescriptorProto) -> bool {
    matches!(field.r#type(), Type::Message | Type::Group)
}

pub(crate) fn type_name(field: &FieldDescriptorProto) -> &str {
    field.type_name().trim_start_matches('.')
}

fn declare<'d>(scope: &str, messages: &'d [DescriptorProto], declared: &mut HashMap<String, &'d DescriptorProto>) {
    for message in messages {
        let name = if scope.is_empty() { message.name().to_owned() } else { format!("{scope}.{}", message.name()) };
        declare(&name, &message.nested_type, declared);
        declared.insert(name, message);
    }
}
