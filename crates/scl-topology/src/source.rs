//! The texts that diagnostics point into, and the places in them.

use std::ops::Range;
use std::sync::Arc;

/// The id of the file in [`Sources`] that a [`Span`] lies in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileId(pub(crate) u16);

/// A range of bytes of one source file; `start == end` marks a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The file.
    pub file: FileId,
    /// The first byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The smallest span that covers both; both lie in one file.
    pub fn to(self, other: Span) -> Span {
        Span { file: self.file, start: self.start.min(other.start), end: self.end.max(other.end) }
    }
}

/// A value and the place where it is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Where it is written.
    pub span: Span,
}

/// One text with the path under which messages name it.
#[derive(Debug, Clone)]
pub struct SourceFile {
    id: FileId,
    path: String,
    text: String,
    has_byte_order_mark: bool,
    line_starts: Vec<u32>,
    /// Number of characters before each block of [`BLOCK`] bytes: lines may be as long as the file.
    characters_before: Vec<u32>,
}

/// Size of the blocks whose characters are counted in advance, in bytes.
const BLOCK: usize = 512;

/// A line of one of the files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Line {
    pub(crate) file: FileId,
    /// From 1.
    pub(crate) number: u32,
}

/// A place as people count it: line and column from 1, the column in characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LineColumn {
    /// The line, from 1.
    pub line: u32,
    /// The column, from 1, in characters.
    pub column: u32,
}

impl SourceFile {
    fn new(id: FileId, path: String, mut text: String) -> Self {
        let has_byte_order_mark = text.starts_with('\u{feff}');
        if has_byte_order_mark {
            text.drain(..'\u{feff}'.len_utf8());
        }
        let line_starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at as u32 + 1)).collect();
        let characters_before = std::iter::once(0)
            .chain(text.as_bytes().chunks(BLOCK).scan(0, |sum, block| {
                *sum += characters_in(block);
                Some(*sum)
            }))
            .collect();
        Self { id, path, text, has_byte_order_mark, line_starts, characters_before }
    }

    /// The id of the file in its [`Sources`].
    pub(crate) fn id(&self) -> FileId {
        self.id
    }

    /// The path, relative to the working folder where possible, as messages print it.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The whole text, without a byte order mark.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the file starts with a byte order mark, which [`text`](Self::text) leaves out.
    pub fn has_byte_order_mark(&self) -> bool {
        self.has_byte_order_mark
    }

    /// Line and column of a byte; a byte past the end counts as the end.
    pub fn line_column(&self, byte: u32) -> LineColumn {
        let line = self.line(byte as usize);
        let start = self.line_starts[line as usize - 1] as usize;
        let mut end = (byte as usize).clamp(start, self.text.len());
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        LineColumn { line, column: self.characters(end) - self.characters(start) + 1 }
    }

    /// Number of characters before a byte in its line.
    pub fn column(&self, byte: u32) -> usize {
        self.line_column(byte).column as usize - 1
    }

    /// Number of characters that begin before a byte.
    fn characters(&self, byte: usize) -> u32 {
        let block = byte / BLOCK;
        let before = self.characters_before.get(block).copied().unwrap_or_default();
        before + characters_in(&self.text.as_bytes()[block * BLOCK..byte])
    }

    /// A line, counted from 1, without its line break; empty past the end.
    pub fn line_text(&self, line: u32) -> &str {
        if line == 0 || line as usize > self.line_starts.len() { "" } else { &self.text[self.range_of_line(line)] }
    }

    /// The first byte of a line, counted from 0; the end of the text if there is no such line.
    pub fn line_start(&self, line: usize) -> usize {
        self.line_starts.get(line).map_or(self.text.len(), |&start| start as usize)
    }

    /// The span of some bytes.
    pub(crate) fn span(&self, range: Range<usize>) -> Span {
        Span { file: self.id, start: range.start as u32, end: range.end as u32 }
    }

    /// `path:line:column` of the start of a span in this file.
    pub fn place(&self, span: Span) -> String {
        let at = self.line_column(span.start);
        format!("{}:{}:{}", self.path, at.line, at.column)
    }

    /// The text that a span covers.
    pub fn snippet(&self, span: Span) -> &str {
        self.text.get(span.start as usize..span.end as usize).unwrap_or("")
    }

    /// The line of a byte, from 1.
    pub(crate) fn line(&self, byte: usize) -> u32 {
        self.line_starts.partition_point(|&start| start as usize <= byte).max(1) as u32
    }

    /// The bytes of the line in which a byte lies, without the line break.
    pub(crate) fn line_range(&self, byte: usize) -> Range<usize> {
        self.range_of_line(self.line(byte))
    }

    /// The bytes of the line below one that ends at a byte, without the line break; nothing at the end of the file.
    pub(crate) fn line_below(&self, end: usize) -> Range<usize> {
        let next = self.text[end..].find('\n').map_or(self.text.len(), |at| end + at + 1);
        self.line_range(next)
    }

    /// The bytes of a line, counted from 1, without the line break.
    pub(crate) fn range_of_line(&self, line: u32) -> Range<usize> {
        let line = line as usize;
        let start = self.line_starts[line - 1] as usize;
        let end = self.line_starts.get(line).map_or(self.text.len(), |&next| next as usize);
        start..start + self.text[start..end].trim_end_matches(['\r', '\n']).len()
    }
}

/// Counts the bytes that begin a character.
fn characters_in(bytes: &[u8]) -> u32 {
    bytes.iter().filter(|&&byte| byte & 0xC0 != 0x80).count() as u32
}

/// All texts of one run: the topology file, those that it includes, and the schema files they name.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    files: Vec<Arc<SourceFile>>,
}

impl Sources {
    /// Creates an empty collection.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a text. A leading byte order mark is removed, so that no position counts it.
    pub fn add(&mut self, path: impl Into<String>, text: impl Into<String>) -> FileId {
        let id = FileId(self.files.len() as u16);
        self.files.push(Arc::new(SourceFile::new(id, path.into(), text.into())));
        id
    }

    /// The same files, with another text in one of them.
    pub fn with_text(&self, file: FileId, text: impl Into<String>) -> Self {
        let mut changed = self.clone();
        let place = &mut changed.files[usize::from(file.0)];
        *place = Arc::new(SourceFile::new(file, place.path.clone(), text.into()));
        changed
    }

    /// Returns the file with this path. Adds it with `text` if there is none yet.
    pub fn add_once(&mut self, path: &str, text: &str) -> FileId {
        match self.files.iter().position(|file| file.path == path) {
            Some(index) => FileId(index as u16),
            None => self.add(path, text),
        }
    }

    /// The file behind an id.
    pub fn file(&self, id: FileId) -> &SourceFile {
        &self.files[usize::from(id.0)]
    }

    /// The line in which a span begins.
    pub(crate) fn line(&self, span: Span) -> Line {
        Line { file: span.file, number: self.file(span.file).line(span.start as usize) }
    }

    /// The text that a span covers.
    pub fn snippet(&self, span: Span) -> &str {
        self.file(span.file).snippet(span)
    }

    /// Returns `text` in the same quotes as the scalar that a span covers, if it has any, to replace that scalar.
    pub fn quoted_as(&self, span: Span, text: &str) -> String {
        match self.snippet(span).chars().next().filter(|first| matches!(first, '"' | '\'')) {
            Some(quote) => format!("{quote}{text}{quote}"),
            None => text.to_owned(),
        }
    }

    /// `path:line:column` of the start of a span.
    pub fn place(&self, span: Span) -> String {
        self.file(span.file).place(span)
    }
}
