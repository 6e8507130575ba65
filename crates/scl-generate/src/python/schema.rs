//! The schema files that the plan of a system contains, with their comments.

use crate::system::System;
use prost_types::FileDescriptorProto;
use scl_loader::{files_for, walk};
use std::collections::{BTreeSet, HashMap};

/// The path of a declaration inside its file, as in `google.protobuf.SourceCodeInfo`.
pub(super) type Path = Vec<i32>;

/// The files, each after the files that it imports.
pub(super) struct Schema<'s> {
    pub(super) files: Vec<SchemaFile<'s>>,
}

/// A file and its comments by path.
pub(super) struct SchemaFile<'s> {
    pub(super) file: &'s FileDescriptorProto,
    comments: HashMap<Path, String>,
}

impl<'s> Schema<'s> {
    /// The files that declare the messages of the system's gates, with all that they import: those of the plan.
    pub(super) fn of(system: &'s System) -> Self {
        let Some(descriptors) = &system.descriptors else { return Self { files: Vec::new() } };
        let gates = system.components.iter().flat_map(|component| &component.gates);
        let used: BTreeSet<&str> =
            gates.flat_map(|gate| &gate.types).filter(|it| it.in_schemas).map(|it| it.dotted.as_str()).collect();
        let files = files_for(&descriptors.file, &used);
        Self { files: files.map(SchemaFile::of).collect() }
    }

    /// The files of the user; protobuf's own have modules in the package `google.protobuf`.
    pub(super) fn own_files(&self) -> impl Iterator<Item = &SchemaFile<'s>> {
        self.files.iter().filter(|file| !file.is_well_known())
    }
}

impl<'s> SchemaFile<'s> {
    fn of(file: &'s FileDescriptorProto) -> Self {
        let locations = file.source_code_info.iter().flat_map(|info| &info.location);
        let commented = locations.filter_map(|location| {
            let comment = [location.leading_comments(), location.trailing_comments()].map(plain);
            let comment = comment.into_iter().filter(|it| !it.is_empty()).collect::<Vec<_>>().join("\n\n");
            (!comment.is_empty()).then(|| (location.path.clone(), comment))
        });
        Self { file, comments: commented.collect() }
    }

    /// `google/protobuf/timestamp.proto` and the like.
    pub(super) fn is_well_known(&self) -> bool {
        self.file.name().starts_with("google/protobuf/")
    }

    pub(super) fn comment(&self, path: &[i32]) -> Option<&str> {
        self.comments.get(path).map(String::as_str)
    }

    /// Whether singular fields without `optional` have presence: not in proto3.
    pub(super) fn has_implicit_presence(&self) -> bool {
        self.file.syntax() != "proto3"
    }

    /// The name with the package and a leading dot, as in references.
    pub(super) fn full_name(&self, name: &str) -> String {
        format!(".{}", walk::full_name(self.file, &[name]))
    }
}

/// A comment without the space that follows `//`.
fn plain(comment: &str) -> String {
    let lines = comment.lines().map(|line| line.strip_prefix(' ').unwrap_or(line).trim_end());
    lines.collect::<Vec<_>>().join("\n").trim().to_owned()
}
