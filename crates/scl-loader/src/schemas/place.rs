//! Places in schema files.

use super::disk::SchemaFile;
use super::folders::Folders;
use crate::request::Request;
use prost_types::FileDescriptorProto;
use scl_topology::source::{Sources, Span};
use std::ops::Range;
use std::path::Path;

/// The schema files as they were read, and how messages name them.
pub(super) struct Texts<'s> {
    pub(super) request: &'s Request,
    pub(super) folders: &'s Folders,
    pub(super) files: &'s [SchemaFile],
    pub(super) sources: &'s mut Sources,
}

/// Finds the declarations of compiled schemas in their texts.
pub(super) struct Places<'s> {
    pub(super) texts: Texts<'s>,
    pub(super) compiled: &'s [FileDescriptorProto],
}

impl Texts<'_> {
    /// A place in a schema, whose text is added to the sources.
    pub(super) fn span(&mut self, file: &SchemaFile, at: Range<usize>) -> Span {
        let end = at.end.min(file.text.len());
        let shown = Path::new(&self.request.shown_as).with_file_name(self.folders.relative(&file.path));
        let id = self.sources.add_once(&shown.display().to_string(), &file.text);
        Span { file: id, start: at.start.min(end) as u32, end: end as u32 }
    }
}

impl Places<'_> {
    /// The place of a declaration, by its path in `google.protobuf.SourceCodeInfo`.
    pub(super) fn of(&mut self, file: &str, path: &[i32]) -> Option<Span> {
        let compiled = self.compiled.iter().find(|compiled| compiled.name() == file)?;
        let locations = &compiled.source_code_info.as_ref()?.location;
        let location = locations.iter().find(|location| location.path == path)?;
        let numbers: Vec<usize> = location.span.iter().map(|&number| number.try_into().unwrap_or_default()).collect();
        let (start, end) = match *numbers.as_slice() {
            [line, start, end] => ((line, start), (line, end)),
            [line, start, last, end] => ((line, start), (last, end)),
            _ => return None,
        };
        let read = self.texts.files.iter().find(|read| read.name == file)?;
        let [start, end] = [start, end].map(|(line, column)| {
            let before: usize = read.text.split_inclusive('\n').take(line).map(str::len).sum();
            before + column
        });
        Some(self.texts.span(read, start..end))
    }
}
