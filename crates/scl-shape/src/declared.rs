//! The messages and enums that files declare, and the message types that a type contains.

use prost_types::field_descriptor_proto::Type;
use prost_types::{DescriptorProto, EnumDescriptorProto, FieldDescriptorProto, FileDescriptorSet};
use std::collections::HashMap;

/// A type and those that it contains at any depth, itself first; `None` if the files do not declare one of them.
pub(crate) fn reachable<'d>(
    files: &'d FileDescriptorSet,
    name: &'d str,
) -> Option<Vec<(&'d str, &'d DescriptorProto)>> {
    let declared = Index::of(files);
    let mut names = vec![name];
    let mut types = Vec::new();
    while let Some(name) = names.get(types.len()).copied() {
        let Item::Message(message) = declared.find(name)? else { return None };
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

#[derive(Clone, Copy)]
pub(crate) enum Item<'d> {
    Message(&'d DescriptorProto),
    Enum(&'d EnumDescriptorProto),
}

/// Finds messages and enums by their full names. Names are kept in parts: whole ones could take far more memory than
/// the descriptors, if a message with a long name contains many others.
pub(crate) struct Index<'d> {
    /// The scope of each package.
    packages: HashMap<&'d str, usize>,
    /// The items by their scope and name; a message comes with the scope of its nested items.
    items: HashMap<(usize, &'d str), (Item<'d>, usize)>,
}

impl<'d> Index<'d> {
    pub(crate) fn of(descriptors: &'d FileDescriptorSet) -> Self {
        let mut index = Self { packages: HashMap::new(), items: HashMap::new() };
        let mut next_scope = 0;
        let mut new_scope = || {
            next_scope += 1;
            next_scope
        };
        for file in &descriptors.file {
            let package = *index.packages.entry(file.package()).or_insert_with(&mut new_scope);
            index.add_enums(package, &file.enum_type);
            let mut messages: Vec<_> = file.message_type.iter().map(|message| (package, message)).collect();
            while let Some((scope, message)) = messages.pop() {
                let own = new_scope();
                index.items.insert((scope, message.name()), (Item::Message(message), own));
                index.add_enums(own, &message.enum_type);
                messages.extend(message.nested_type.iter().map(|nested| (own, nested)));
            }
        }
        index
    }

    fn add_enums(&mut self, scope: usize, enums: &'d [EnumDescriptorProto]) {
        self.items.extend(enums.iter().map(|found| ((scope, found.name()), (Item::Enum(found), 0))));
    }

    /// Finds an item by its full name. The longest package is tried first, because the name does not show where the
    /// package ends.
    pub(crate) fn find(&self, name: &str) -> Option<Item<'d>> {
        let dots = name.rmatch_indices('.').map(|(at, _)| (&name[..at], &name[at + 1..]));
        dots.chain([("", name)]).find_map(|(package, path)| {
            let mut found = (None, *self.packages.get(package)?);
            for part in path.split('.') {
                let (item, scope) = *self.items.get(&(found.1, part))?;
                found = (Some(item), scope);
            }
            found.0
        })
    }
}
