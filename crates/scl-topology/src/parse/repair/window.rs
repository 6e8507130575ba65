//! The part of a file that is read again for each change: all of a small file, else a section's head and the list items
//! around the error.

use super::Edit;
use crate::parse::pitfall::scan;
use crate::source::SourceFile;
use crate::yaml::SyntaxError;
use std::ops::Range;

/// A file up to this size is read as a whole.
const WHOLE: usize = 512;

/// A file up to this size is read as a whole where its parts cannot be read by themselves.
const WHOLE_IN_NEED: usize = 4096;

/// Maximum size of a part; a larger one is not read again for each change.
const LARGEST: usize = 8192;

/// Minimum distance from the start of a part to the error, because a text may extend over several items.
const LEAST_ABOVE: usize = 600;

/// Maximum number of lines that are suspected of the mistake.
const MOST_LINES: usize = 12;

/// Number of lines that are searched for suspects, above the error and around an open bracket.
const MOST_ABOVE: usize = 60;

/// A part of the text that can be read by itself.
pub(super) struct Window {
    /// The line with the section's key; empty if the part begins with one.
    head: Range<usize>,
    /// The part itself.
    pub(super) range: Range<usize>,
}

impl Window {
    /// The part, perhaps with a change in it.
    pub(super) fn with(&self, edit: Option<&Edit>, text: &str) -> String {
        let mut out = text[self.head.clone()].to_owned();
        let mut at = self.range.start;
        for (range, with) in edit.iter().flat_map(|edit| &edit.changes) {
            out.push_str(&text[at..range.start]);
            out.push_str(with);
            at = range.end;
        }
        out.push_str(&text[at..self.range.end]);
        out
    }
}

impl Window {
    /// The parts up to the line in which the parser stopped, or to the end of what is in brackets there, and up to the
    /// line above it, unless that line is in brackets; but not all of it.
    pub(super) fn without_lines_below(&self, error: &SyntaxError, text: &str, source: &SourceFile) -> Vec<Self> {
        let with_break = |end: usize| text[end..].find('\n').map_or(text.len(), |found| end + found + 1);
        let line = source.line_range(error.at.min(text.len()));
        let mut end = with_break(line.end);
        while end < self.range.end && !scan::scan(&text[self.range.start..end]).open_brackets.is_empty() {
            end = with_break(end);
        }
        let indent_of = |line: &str| line.len() - line.trim_start_matches(' ').len();
        let above = text.get(self.range.start..line.start).unwrap_or_default();
        let open = scan::scan(above).open_brackets.first().map(|open| source.line_range(self.range.start + open));
        let is_inside = open.is_some_and(|open| indent_of(&text[line.clone()]) > indent_of(&text[open]));
        let ends = std::iter::once(end).chain(Some(line.start).filter(|_| !is_inside));
        let ends = ends.filter(|end| self.range.start < *end && *end < self.range.end);
        ends.map(|end| Self { head: self.head.clone(), range: self.range.start..end }).collect()
    }
}

pub(super) fn around(error: &SyntaxError, text: &str, source: &SourceFile) -> Option<Window> {
    let whole = || Window { head: 0..0, range: 0..text.len() };
    if text.len() <= WHOLE {
        return Some(whole());
    }
    of_section(error, text, source).or_else(|| (text.len() <= WHOLE_IN_NEED).then(whole))
}

/// The head of the section in which the parser stopped, and the items around.
fn of_section(error: &SyntaxError, text: &str, source: &SourceFile) -> Option<Window> {
    let at = source.line_range(error.at.min(text.len())).start;
    let is_key = |line: &str| line.starts_with(|c: char| c.is_ascii_alphabetic());
    let head = lines_up(text, at).find(|line| is_key(&text[line.clone()]))?;
    if !text[head.clone()].trim_end().ends_with(':') {
        return None;
    }
    let first = text[head.end..].lines().find(|line| line.trim_start().starts_with("- "))?;
    let indent = first.len() - first.trim_start().len();
    let starts_item =
        |line: &str| line.trim_start().starts_with("- ") && line.len() - line.trim_start().len() == indent;
    let starts = lines_up(text, at).take_while(|line| line.start > head.start);
    let mut starts = starts.filter(|line| starts_item(&text[line.clone()])).skip(2);
    let from = starts.find(|line| at - line.start > LEAST_ABOVE).map_or(head.end, |line| line.start);
    let mut to = at;
    let mut items = 0;
    for line in text[at..].split_inclusive('\n') {
        items += usize::from(starts_item(line) && to > at);
        if items > 2 || to > from + LARGEST {
            break;
        }
        to += line.len();
    }
    (to - from <= LARGEST).then_some(Window { head, range: from..to })
}

/// The lines that may hold the mistake, the most suspect first.
pub(super) fn suspects(error: &SyntaxError, text: &str, source: &SourceFile, window: &Window) -> Vec<Range<usize>> {
    let here = source.line_range(error.at.min(text.len()));
    let mut lines = vec![here.clone()];
    let is_blank = |line: &Range<usize>| {
        let content = text[line.clone()].trim();
        content.is_empty() || content.starts_with('#')
    };
    let above: Vec<Range<usize>> = lines_up(text, here.start)
        .take(MOST_ABOVE)
        .filter(|line| !is_blank(line))
        .take_while(|line| line.end > window.range.start)
        .map(|line| source.line_range(line.start))
        .collect();
    let items = above.iter().filter(|line| text[(*line).clone()].trim_start().starts_with("- ")).take(2);
    // A text that spans several lines may begin at the head of its list: suspect that line and the one below it.
    let list = above.iter().position(|line| text[line.clone()].trim_end().ends_with(':'));
    let start = match list {
        Some(at) => &above[at.saturating_sub(1)..=at],
        None => &above[above.len().saturating_sub(1)..],
    };
    let section = above.iter().position(|line| !text[line.clone()].starts_with([' ', '-'])).unwrap_or(above.len());
    let first = section.checked_sub(1).and_then(|at| above.get(at));
    lines.extend(above.iter().take(2).chain(items).chain(start).chain(first).cloned());
    lines.extend(unbalanced(error, text, source, window));
    let mut seen = Vec::new();
    lines.retain(|line| {
        !is_blank(line) && !seen.contains(line) && {
            seen.push(line.clone());
            true
        }
    });
    lines.truncate(MOST_LINES);
    lines
}

/// The lines from an open bracket on that may hold a mistake with brackets: those that do not close exactly what they
/// open, end with a colon, or start with a comma or a closing bracket.
fn unbalanced(error: &SyntaxError, text: &str, source: &SourceFile, window: &Window) -> Vec<Range<usize>> {
    let at = error.at.min(text.len());
    let in_window = &text[window.range.start..at.max(window.range.start)];
    let open = scan::scan(in_window).open_brackets.first().map_or(at, |open| window.range.start + open);
    let mut found = Vec::new();
    let mut start = source.line_range(open).start;
    for line in text[start..window.range.end].split_inclusive('\n').take(MOST_ABOVE) {
        let balance = line.bytes().fold([0_i32; 2], |[square, curly], byte| match byte {
            b'[' => [square + 1, curly],
            b']' => [square - 1, curly],
            b'{' => [square, curly + 1],
            b'}' => [square, curly - 1],
            _ => [square, curly],
        });
        let content = line.trim();
        if balance != [0, 0] || content.ends_with(':') || content.starts_with([',', ']', '}']) {
            found.push(source.line_range(start));
        }
        start += line.len();
    }
    found
}

/// The lines above a line, the nearest first, each with its line break.
fn lines_up(text: &str, start: usize) -> impl Iterator<Item = Range<usize>> {
    let mut end = start;
    std::iter::from_fn(move || {
        let before = text.get(..end)?.strip_suffix('\n')?;
        let line = before.rfind('\n').map_or(0, |at| at + 1)..end;
        end = line.start;
        Some(line)
    })
}
