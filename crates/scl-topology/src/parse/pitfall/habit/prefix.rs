//! What stands before the lines of a text that was copied from a diff or a listing.

use super::{Found, Way, line_list, lines};
use crate::source::SourceFile;
use std::ops::Range;

/// How the lines start that describe a diff.
const HEADS: [&str; 5] = ["@@ ", "diff --git ", "index ", "+++ ", "--- a/"];

/// The `+` before the new lines of a diff, and the lines around them.
pub(super) fn diff(text: &str, source: &SourceFile) -> Option<Found> {
    let is_head = |line: &str| HEADS.iter().any(|head| line.starts_with(head));
    let heads: Vec<(usize, &str)> = lines(text).filter(|(_, line)| is_head(line)).collect();
    let is_diff = heads.iter().any(|(_, line)| line.starts_with("@@ "));
    let is_removed = |line: &str| is_diff && line.starts_with('-') && !is_head(line);
    let is_added = |line: &str| line.starts_with('+') && !is_head(line);
    let found: Vec<(usize, &str)> =
        lines(text).filter(|(_, line)| is_head(line) || is_added(line) || is_removed(line)).collect();
    let (first, line) = *found.first()?;
    let way = |help: String, with: &str| {
        let changes = found.iter().map(|(start, line)| match is_added(line) {
            true => (*start..start + 1, with.to_owned()),
            false => (*start..start + line.len(), String::new()),
        });
        Way { help, changes: changes.collect() }
    };
    let added: Vec<usize> = found.iter().filter(|(_, line)| is_added(line)).map(|(start, _)| *start).collect();
    let places = line_list(&added, source);
    let rest = if added.len() < found.len() { ", and the other lines of the diff" } else { "" };
    let ways = match added.is_empty() {
        true => vec![way("remove the lines of the diff".to_owned(), "")],
        false => vec![
            way(format!("remove the `+` of {places}{rest}"), ""),
            way(format!("write a space in place of the `+` of {places}{rest}"), " "),
        ],
    };
    let at = if is_added(line) { first..first + 1 } else { first..first + line.trim_end().len() };
    Some(Found {
        at,
        message: "this is a line of a diff, not YAML".to_owned(),
        label: "a mark of the diff",
        ways,
        is_certain: false,
        otherwise: None,
    })
}

/// Line numbers that were copied with the lines.
pub(super) fn line_numbers(text: &str, source: &SourceFile) -> Option<Found> {
    let mut found: Vec<(Range<usize>, &str)> = Vec::new();
    let mut next = None;
    for (start, line) in lines(text) {
        let number = numbered(line).filter(|(number, _)| next.is_none_or(|next| next == *number));
        match number {
            Some((number, length)) => {
                found.push((start..start + length, line));
                next = Some(number + 1);
            }
            None if found.len() > 1 => break,
            None => {
                found.clear();
                next = None;
            }
        }
    }
    let first = found.first().filter(|_| found.len() > 1)?.0.clone();
    let starts: Vec<usize> = found.iter().map(|(at, _)| at.start).collect();
    let help = format!("remove the numbers before {}", line_list(&starts, source));
    let changes = found.iter().map(|(at, line)| {
        let space = usize::from(line[at.len()..].starts_with([' ', '\t']));
        (at.start..at.end + space, String::new())
    });
    let changes = changes.collect();
    Some(Found {
        at: first,
        message: "these lines begin with line numbers".to_owned(),
        label: "copied from a listing",
        ways: vec![Way { help, changes }],
        is_certain: false,
        otherwise: None,
    })
}

/// The number at the start of a line, and the length of the number with its mark.
fn numbered(line: &str) -> Option<(u32, usize)> {
    let content = line.trim_start_matches(' ');
    let digits = content.len() - content.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let number = content[..digits].parse().ok()?;
    let rest = &content[digits..];
    let mark = usize::from(rest.starts_with([':', '|', '.', ')']));
    let is_end = rest.len() == mark || rest[mark..].starts_with([' ', '\t', '\n', '\r']);
    is_end.then_some((number, line.len() - content.len() + digits + mark))
}
