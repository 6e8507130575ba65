//! Changes of indentation, for proposals.

use crate::diagnostic::Edit;
use crate::source::{SourceFile, Span};

/// Indents the lines of a block by more spaces, the first one only if `has_first`.
pub(super) fn indented(block: Span, by: usize, has_first: bool, source: &SourceFile) -> Vec<Edit> {
    let spaces = " ".repeat(by);
    let starts = line_starts(block, has_first, source).filter(|&at| !is_blank(at, source));
    starts.map(|at| Edit::new(Span { start: at, end: at, ..block }, spaces.clone())).collect()
}

/// Removes spaces at the start of each line of a block, of the first one only if `has_first`. None if a line is
/// indented less.
pub(super) fn outdented(block: Span, by: usize, has_first: bool, source: &SourceFile) -> Option<Vec<Edit>> {
    let starts: Vec<u32> = line_starts(block, has_first, source).filter(|&at| !is_blank(at, source)).collect();
    let removed = |at: u32| {
        let span = Span { start: at, end: at + by as u32, ..block };
        let spaces = source.snippet(span);
        (spaces.len() == by && spaces.bytes().all(|byte| byte == b' ')).then(|| Edit::new(span, ""))
    };
    starts.into_iter().map(removed).collect()
}

/// The text of a line before a place.
pub(super) fn head(at: u32, source: &SourceFile) -> &str {
    let start = source.line_range(at as usize).start;
    source.text().get(start..at as usize).unwrap_or("")
}

fn is_blank(at: u32, source: &SourceFile) -> bool {
    source.text().get(source.line_range(at as usize)).is_none_or(|line| line.trim().is_empty())
}

fn line_starts(block: Span, has_first: bool, source: &SourceFile) -> impl Iterator<Item = u32> {
    let first = has_first.then(|| source.line_range(block.start as usize).start as u32);
    let breaks = source.snippet(block).match_indices('\n').map(move |(at, _)| block.start + at as u32 + 1);
    first.into_iter().chain(breaks)
}
