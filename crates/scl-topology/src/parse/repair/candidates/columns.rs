//! Other columns for a line, with the lines that belong to it.

use super::super::line::{Class, Token};
use super::super::{Edit, Kind};
use super::MOST_ABOVE;
use crate::source::SourceFile;
use std::ops::Range;

/// How many lines below a line may move with it.
const MOST_BELOW: usize = 64;

/// Number of lines of a file in which list items are counted to find the usual column.
const MOST_LINES: usize = 400;

/// Proposes to move the line, with all that is indented deeper below it, to each of the columns that the lines above
/// use.
pub(super) fn columns(tokens: &[Token], line: &Range<usize>, text: &str, source: &SourceFile, edits: &mut Vec<Edit>) {
    let Some(first) = tokens.first() else { return };
    let indent = first.range.start - line.start;
    let mut meant = vec![0];
    let mut at = line.start;
    for _ in 0..MOST_ABOVE {
        let Some(above) = at.checked_sub(1).map(|at| source.line_range(at)) else { break };
        let content = &text[above.clone()];
        let dash = content.len() - content.trim_start_matches(' ').len();
        let word = content.len() - content.trim_start_matches([' ', '-']).len();
        meant.extend([dash, word].into_iter().filter(|_| !content.trim().is_empty()));
        at = above.start;
    }
    let below = source.line_below(line.end);
    meant.push(text[below.clone()].len() - text[below].trim_start_matches(' ').len());
    meant.sort_unstable();
    meant.dedup();
    let word = text[first.range.clone()].len();
    for column in meant.into_iter().filter(|column| *column != indent) {
        let moved = with_lines_below(line, indent, column, text);
        let kind = Kind::Indent(first.range.start..first.range.start + word, column);
        let is_dash = first.class == Class::Dash;
        let is_rarer = is_dash && used(column, text) < used(indent, text);
        let cost = 2 + usize::from(column.abs_diff(indent) > 2) + usize::from(is_rarer);
        let single = (line.start..line.start + indent, " ".repeat(column));
        if moved.len() > 1 && column > indent {
            let changes = moved.iter().map(|at| (*at..*at, " ".repeat(column - indent)));
            edits.push(Edit { kind: kind.clone(), changes: changes.collect(), cost });
        } else if moved.len() > 1 {
            let changes = moved.iter().map(|at| (*at..*at + indent - column, String::new()));
            edits.push(Edit { kind: kind.clone(), changes: changes.collect(), cost });
        }
        edits.push(Edit { kind, changes: vec![single], cost });
    }
}

/// How many list items of the file, up to some line, stand in a column.
fn used(column: usize, text: &str) -> usize {
    let stands_there =
        |line: &&str| line.len() - line.trim_start_matches(' ').len() == column && line[column..].starts_with("- ");
    text.lines().take(MOST_LINES).filter(stands_there).count()
}

/// The starts of a line and of those below it that are indented deeper, up to an item that would stand beside it in the
/// new column.
fn with_lines_below(line: &Range<usize>, indent: usize, column: usize, text: &str) -> Vec<usize> {
    let mut starts = vec![line.start];
    let mut start = line.start;
    for (number, below) in text[line.start..].split_inclusive('\n').take(MOST_BELOW).enumerate() {
        let own = below.len() - below.trim_start_matches(' ').len();
        if number > 0 && !below.trim().is_empty() {
            let is_sibling = own <= column && below.trim_start().starts_with("- ");
            if own <= indent || is_sibling {
                break;
            }
            starts.push(start);
        }
        start += below.len();
    }
    starts
}
