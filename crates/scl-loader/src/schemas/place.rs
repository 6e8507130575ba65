//! Places in schema files.

use super::disk::SchemaFile;
use super::folders::Folders;
use crate::request::Request;
use prost_types::FileDescriptorProto;
use scl_topology::source::{FileId, Sources, Span};
use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

/// The schema files as they were read, and how messages name them.
pub(super) struct Texts<'s> {
    pub(super) request: &'s Request,
    pub(super) folders: &'s Folders,
    pub(super) files: &'s [SchemaFile],
    pub(super) sources: &'s mut Sources,
}

impl Texts<'_> {
    /// A place in a schema, whose text is added to the sources.
    pub(super) fn span(&mut self, file: &SchemaFile, at: Range<usize>) -> Span {
        let end = at.end.min(file.text.len());
        Span { file: self.add(file), start: at.start.min(end) as u32, end: end as u32 }
    }

    fn add(&mut self, file: &SchemaFile) -> FileId {
        let shown = Path::new(&self.request.shown_as).with_file_name(self.folders.relative(&file.path));
        self.sources.add_once(&shown.display().to_string(), &file.text)
    }
}

/// Finds the declarations of compiled schemas in their texts.
pub(super) struct Places<'s> {
    texts: Texts<'s>,
    compiled: &'s [FileDescriptorProto],
    /// Made for the first problem.
    spans: Option<Spans<'s>>,
}

/// Lines and columns from 0, in bytes, by file and by path as in `google.protobuf.SourceCodeInfo`.
type Spans<'s> = HashMap<(&'s str, &'s [i32]), &'s [i32]>;

impl<'s> Places<'s> {
    pub(super) fn new(texts: Texts<'s>, compiled: &'s [FileDescriptorProto]) -> Self {
        Self { texts, compiled, spans: None }
    }

    /// The place of a declaration, by its path in `google.protobuf.SourceCodeInfo`.
    pub(super) fn of(&mut self, file: &str, path: &[i32]) -> Option<Span> {
        let spans = self.spans.get_or_insert_with(|| spans(self.compiled));
        let (start, end) = match **spans.get(&(file, path))? {
            [line, start, end] => ((line, start), (line, end)),
            [line, start, last, end] => ((line, start), (last, end)),
            _ => return None,
        };
        let read = self.texts.files.iter().find(|read| read.name == file)?;
        let id = self.texts.add(read);
        let text = self.texts.sources.file(id);
        let byte = |(line, column): (i32, i32)| {
            let at = text.line_start(line.try_into().ok()?) + usize::try_from(column).ok()?;
            Some(at.min(text.text().len()) as u32)
        };
        Some(Span { file: id, start: byte(start)?, end: byte(end)? })
    }
}

fn spans(compiled: &[FileDescriptorProto]) -> Spans<'_> {
    let spans = compiled.iter().flat_map(|file| {
        let locations = file.source_code_info.iter().flat_map(|info| &info.location);
        locations.map(|location| ((file.name(), location.path.as_slice()), location.span.as_slice()))
    });
    spans.collect()
}
