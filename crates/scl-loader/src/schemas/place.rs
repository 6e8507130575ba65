//! Places in schema files: where a declaration is written.

use super::disk::SchemaFile;
use crate::request::Request;
use prost_types::FileDescriptorProto;
use scl_topology::source::{FileId, Sources, Span};
use std::collections::HashMap;
use std::path::Path;

/// Finds declarations of compiled schemas in their texts.
pub(super) struct Places<'a> {
    pub(super) request: &'a Request,
    pub(super) sources: &'a mut Sources,
    /// The files as they were read.
    pub(super) files: &'a [SchemaFile],
    pub(super) compiled: &'a [FileDescriptorProto],
    /// The files that have been added to `sources`.
    pub(super) added: HashMap<String, FileId>,
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
        let text = &self.files.iter().find(|read| read.name == file)?.text;
        let [start, end] = [start, end].map(|(line, column)| {
            let before: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
            (before + column).min(text.len()) as u32
        });
        let shown = shown_beside(&self.request.shown_as, file);
        let id = *self.added.entry(file.to_owned()).or_insert_with(|| self.sources.add(shown, text.clone()));
        Some(Span { file: id, start, end })
    }
}

/// The path under which messages name a schema, in the manner of the topology file's own.
pub(super) fn shown_beside(topology: &str, name: &str) -> String {
    Path::new(topology).with_file_name(name).display().to_string()
}
