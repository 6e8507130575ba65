//! Comments as other languages write them.

use super::{Found, Way, lines as all_lines};
use crate::source::SourceFile;
use std::ops::Range;

/// What starts a comment that ends with its line, and where.
const MARKS: [(&str, &str); 5] = [
    ("//", "C++ and JavaScript"),
    (";", "INI files"),
    ("--", "SQL and Lua"),
    ("%", "TeX and MATLAB"),
    ("REM ", "batch files"),
];

/// What opens and closes a comment, and where.
const PAIRS: [(&str, &str, &str); 3] =
    [("/*", "*/", "C"), ("<!--", "-->", "XML and HTML"), ("(*", "*)", "Structured Text and Pascal")];

/// Marks that also follow a value in the same line.
const TRAILING: [&str; 4] = ["//", ";", "--", "%"];

/// Comments up to the end of the line.
pub(super) fn lines(text: &str, source: &SourceFile) -> Option<Found> {
    MARKS.iter().find_map(|(mark, language)| {
        let found = marks(text, mark);
        let first = found.first()?.clone();
        let content = text[first.end..source.line_range(first.start).end].trim();
        let help = match found.len() {
            1 if content.is_empty() => "write `#`".to_owned(),
            1 => format!("write `# {content}`"),
            2 => format!("write `#` in place of `{}` in both lines", mark.trim()),
            count => format!("write `#` in place of `{}` in all {count} lines", mark.trim()),
        };
        let changes = found.into_iter().map(|at| {
            let is_spaced = text[at.end..].starts_with([' ', '\n', '\r']) || at.end == text.len();
            (at, if is_spaced { "#".to_owned() } else { "# ".to_owned() })
        });
        Some(Found {
            at: first,
            message: format!("`{}` starts a comment in {language}; in YAML, `#` does", mark.trim()),
            label: "starts no comment here",
            ways: vec![Way { help, changes: changes.collect() }],
            is_certain: *mark != "--",
            otherwise: Some("a comment starts with `#`"),
        })
    })
}

/// Comments between two marks, perhaps over several lines.
pub(super) fn block(text: &str, source: &SourceFile) -> Option<Found> {
    PAIRS.iter().find_map(|(open, close, language)| {
        let mut changes = Vec::new();
        let mut first: Option<Range<usize>> = None;
        let mut last = 0;
        let mut at = 0;
        while let Some(start) = text[at..].find(open).map(|found| at + found) {
            let line = source.line_range(start);
            let before = &text[line.start..start];
            let end = text[start..].find(close).map(|found| start + found);
            let end = end.filter(|_| before.trim().is_empty() || before.ends_with(' ') && !before.contains('#'))?;
            at = end + close.len();
            if !text[at..source.line_range(end).end].trim().is_empty() {
                return None;
            }
            first.get_or_insert(start..start + open.len());
            last = end;
            change(start + open.len(), start, end, close, text, &mut changes);
        }
        let at = first?;
        let (from, to) = (source.line(at.start), source.line(last));
        let content = text[at.end..last].trim();
        let help = match from == to {
            true => format!("write `# {content}`"),
            false => format!("write `#` before each line of the comment, lines {from} to {to}"),
        };
        Some(Found {
            at,
            message: format!("`{open}` starts a comment in {language}; in YAML, `#` does"),
            label: "starts no comment here",
            ways: vec![Way { help, changes }],
            is_certain: true,
            otherwise: Some("a comment starts with `#`, in each of its lines"),
        })
    })
}

/// Turns one comment into lines with `#`.
fn change(
    content: usize,
    start: usize,
    end: usize,
    close: &str,
    text: &str,
    changes: &mut Vec<(Range<usize>, String)>,
) {
    changes.push((start..content, "#".to_owned()));
    let mut at = content;
    while let Some(next) = text[at..end].find('\n').map(|found| at + found + 1) {
        let line = &text[next..end];
        let indent = line.len() - line.trim_start_matches(' ').len();
        let is_starred = line[indent..].starts_with('*') || indent == line.len() && close == "*/";
        let from = next + indent.min(line.len());
        let star = usize::from(is_starred && line[indent..].starts_with('*'));
        changes.push((from..from + star, if is_starred { "#".to_owned() } else { "# ".to_owned() }));
        at = next;
    }
    let trimmed = text[..end].trim_end_matches(' ').len().max(changes.last().map_or(content, |(range, _)| range.end));
    changes.push((trimmed..end + close.len(), String::new()));
}

/// Lines that start with the mark of a comment, and comments behind a bracket.
fn marks(text: &str, mark: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    for (start, line) in all_lines(text) {
        let content = line.trim_start();
        let at = start + line.len() - content.len();
        let is_mark = content.strip_prefix(mark).is_some_and(|rest| mark != "--" || !is_item(rest.trim_start()));
        if is_mark && !content.starts_with("---") {
            found.push(at..at + mark.len());
        } else if TRAILING.contains(&mark)
            && let Some(before) = trailing(line, mark)
        {
            found.push(start + before..start + before + mark.len());
        }
    }
    found
}

/// `-- name: a` and `-- [a.b, c.d]` are items with two dashes.
fn is_item(rest: &str) -> bool {
    rest.starts_with(['[', '{']) || rest.split(' ').next().is_some_and(|word| word.trim_end().ends_with(':'))
}

/// The place of a mark after a closing bracket and a space.
fn trailing(line: &str, mark: &str) -> Option<usize> {
    let (at, _) = line.match_indices(mark).find(|(at, _)| line[..*at].ends_with(' '))?;
    let before = line[..at].trim_end();
    let is_text = line[at + mark.len()..].starts_with(|c: char| c == ' ' || c.is_alphanumeric());
    (before.ends_with([']', '}']) && is_text).then_some(at)
}
