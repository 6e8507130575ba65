//! The lines that a diagnostic points into, and nothing between them: the cost of a diagnostic must not depend on how
//! far apart its labels are, nor on how long a line is.

use super::one_line;
use crate::diagnostic::Label;
use crate::source::{FileId, LineColumn, SourceFile};
use std::ops::Range;

/// Lines without a label are shown between two labelled ones if there are no more than this.
const MOST_BETWEEN: u32 = 1;

/// Longer lines, in bytes, are cut around their labels.
const LONG_LINE: usize = 400;

/// How many bytes of a long line are shown on each side of a label.
const AROUND: usize = 60;

/// How many bytes of a long label are shown, besides [`AROUND`].
const LONGEST_MARK: usize = 120;

/// What a diagnostic shows of one file.
pub(super) struct Excerpt<'s> {
    pub(super) path: &'s str,
    /// The place of the primary label, or of the first one in the file.
    pub(super) at: LineColumn,
    /// In the order of their lines.
    pub(super) chunks: Vec<Chunk>,
}

/// Labelled lines that stand close together.
pub(super) struct Chunk {
    pub(super) first_line: u32,
    pub(super) text: String,
    pub(super) marks: Vec<Mark>,
}

/// A label in the text of its chunk.
pub(super) struct Mark {
    pub(super) range: Range<usize>,
    pub(super) is_primary: bool,
    pub(super) text: String,
}

impl<'s> Excerpt<'s> {
    /// Creates the excerpt of `source` for those labels that lie in it; there must be at least one.
    pub(super) fn new(source: &'s SourceFile, file: FileId, labels: &[(&Label, bool)]) -> Self {
        let mut marks: Vec<(u32, Mark)> = labels
            .iter()
            .filter(|(label, _)| label.span.file == file)
            .map(|(label, is_primary)| {
                let range = first_line_of(label, source);
                let text = one_line(&label.text);
                (source.line(range.start), Mark { range, is_primary: *is_primary, text })
            })
            .collect();
        marks.sort_by_key(|(line, _)| *line);
        let first = marks.iter().min_by_key(|(line, mark)| (!mark.is_primary, *line, mark.range.start));
        let at = source.line_column(first.map_or(0, |(_, mark)| mark.range.start as u32));
        let mut chunks: Vec<Chunk> = Vec::new();
        while let Some(&(line, _)) = marks.first() {
            let rest = marks.split_off(marks.partition_point(|(other, _)| *other == line));
            let of_line = marks.into_iter().map(|(_, mark)| mark).collect();
            match chunks.last_mut().filter(|chunk| line - chunk.last_line() <= MOST_BETWEEN + 1) {
                Some(chunk) => chunk.extend(line, of_line, source),
                None => chunks.push(Chunk::new(line, of_line, source)),
            }
            marks = rest;
        }
        Self { path: source.path(), at, chunks }
    }
}

impl Chunk {
    fn new(line: u32, marks: Vec<Mark>, source: &SourceFile) -> Self {
        let (text, marks) = cut(source, line, marks);
        Self { first_line: line, text, marks }
    }

    fn last_line(&self) -> u32 {
        self.first_line + self.text.matches('\n').count() as u32
    }

    /// Appends a line with its marks, after the unmarked lines before it.
    fn extend(&mut self, line: u32, marks: Vec<Mark>, source: &SourceFile) {
        for between in self.last_line() + 1..line {
            self.text.push('\n');
            self.text.push_str(&cut(source, between, Vec::new()).0);
        }
        let (text, marks) = cut(source, line, marks);
        self.text.push('\n');
        let start = self.text.len();
        self.text.push_str(&text);
        let moved = |mark: Mark| Mark { range: mark.range.start + start..mark.range.end + start, ..mark };
        self.marks.extend(marks.into_iter().map(moved));
    }
}

/// Cuts a long line to the parts around its marks. Returns the text, and the marks in it.
fn cut(source: &SourceFile, line: u32, mut marks: Vec<Mark>) -> (String, Vec<Mark>) {
    let place = source.range_of_line(line);
    let text = &source.text()[place.clone()];
    for mark in &mut marks {
        mark.range = mark.range.start - place.start..mark.range.end - place.start;
    }
    if text.len() <= LONG_LINE {
        return (text.to_owned(), marks);
    }
    let mut shown = String::new();
    let mut cut = Vec::new();
    for window in windows(text, &marks) {
        if window.start > 0 {
            shown.push_str("...");
        }
        let (start, offset) = (window.start, shown.len());
        shown.push_str(&text[window.clone()]);
        let in_window = |at: usize| at.clamp(window.start, window.end) - start + offset;
        for mark in marks.extract_if(.., |mark| mark.range.start <= window.end) {
            cut.push(Mark { range: in_window(mark.range.start)..in_window(mark.range.end), ..mark });
        }
    }
    shown.push_str("...");
    (shown, cut)
}

/// The parts of a long line that are shown, in order; its start if it has no marks.
fn windows(text: &str, marks: &[Mark]) -> Vec<Range<usize>> {
    let around = |mark: &Mark| {
        let end = mark.range.end.min(mark.range.start + LONGEST_MARK);
        boundary(text, mark.range.start.saturating_sub(AROUND))..boundary(text, end + AROUND)
    };
    let mut all: Vec<Range<usize>> = marks.iter().map(around).collect();
    all.sort_by_key(|window| window.start);
    let mut windows: Vec<Range<usize>> = Vec::new();
    for window in all {
        match windows.last_mut().filter(|last| window.start <= last.end) {
            Some(last) => last.end = last.end.max(window.end),
            None => windows.push(window),
        }
    }
    if windows.is_empty() {
        windows.push(0..boundary(text, LONGEST_MARK));
    }
    windows
}

/// The last boundary of a character up to a byte.
fn boundary(text: &str, byte: usize) -> usize {
    (0..=byte.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or_default()
}

/// The part of a label in its first line: a frame around many lines would hide what it is about.
fn first_line_of(label: &Label, source: &SourceFile) -> Range<usize> {
    let text = source.text();
    let start = boundary(text, label.span.start as usize);
    let line = source.line_range(start);
    let start = start.min(line.end);
    let mut end = (label.span.end as usize).clamp(start, line.end);
    while !text.is_char_boundary(end) {
        end += 1;
    }
    start..end
}
