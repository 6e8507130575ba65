//! The part of the compiled schemas that describes some messages, as bytes that a program can carry.

use super::{Schemas, walk};
use prost::Message;
use prost_types::{FileDescriptorProto, FileDescriptorSet};
use scl_plan::Schema;
use scl_topology::fingerprint;
use std::collections::BTreeSet;

impl Schemas {
    /// The files that declare these messages, with all that they import, without comments and positions. Each file
    /// comes after the files that it imports. `None` if no file declares any of them.
    ///
    /// The same schemas and messages always give the same bytes.
    pub fn descriptors_of(&self, messages: &BTreeSet<&str>) -> Option<Schema> {
        let files = files_for(&self.file_descriptor_set.file, messages);
        let file: Vec<_> = files.map(|file| FileDescriptorProto { source_code_info: None, ..file.clone() }).collect();
        if file.is_empty() {
            return None;
        }
        let descriptors = FileDescriptorSet { file }.encode_to_vec();
        Some(Schema { hash: fingerprint::long(&descriptors), descriptors: descriptors.into() })
    }
}

/// The files among `all` that declare these messages, with all that they import, each after those that it imports if
/// that is the order of `all`.
pub fn files_for<'a>(
    all: &'a [FileDescriptorProto],
    messages: &BTreeSet<&str>,
) -> impl Iterator<Item = &'a FileDescriptorProto> + use<'a> {
    let needed = with_imports(all, all.iter().filter(|file| declares_any(file, messages)));
    all.iter().filter(move |file| needed.contains(file.name()))
}

fn declares_any(file: &FileDescriptorProto, messages: &BTreeSet<&str>) -> bool {
    walk::messages(file).iter().any(|(path, _)| messages.contains(walk::full_name(file, path).as_str()))
}

/// The names of these files and of all files that they import, directly or not.
fn with_imports<'a>(
    all: &'a [FileDescriptorProto],
    files: impl Iterator<Item = &'a FileDescriptorProto>,
) -> BTreeSet<&'a str> {
    let mut names = BTreeSet::new();
    let mut open: Vec<&FileDescriptorProto> = files.collect();
    while let Some(file) = open.pop() {
        if names.insert(file.name()) {
            open.extend(all.iter().filter(|other| file.dependency.iter().any(|name| name == other.name())));
        }
    }
    names
}
