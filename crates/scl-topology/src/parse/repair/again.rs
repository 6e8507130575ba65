//! The same mistake in the lines below: a change of the first alone leaves the text unreadable right after it, and
//! would not pass its trial.

use super::window::{self, Window};
use super::{Edit, Kind, Ways, find_in, parts, problems_left};
use crate::advice::reach;
use crate::parse::dialect::Dialect;
use crate::source::Sources;
use crate::yaml;
use std::mem::discriminant;

/// Maximum number of lines that are corrected together.
const MOST: usize = 24;

/// Maximum size of all texts that are read to find them.
const MOST_BYTES: usize = 1 << 18;

/// The changes of later lines.
#[derive(Default)]
pub(super) struct Later {
    pub(super) edits: Vec<Edit>,
    /// Each of them is certain, and no problem is left.
    pub(super) is_meant: bool,
}

/// The changes of the same kind that let the parser read on, after the first one.
pub(super) fn later(first: &Edit, ways: Ways<'_>, text: &str, dialect: &Dialect) -> Later {
    let mut later = Later { edits: Vec::new(), is_meant: true };
    if !is_repeatable(&first.kind) {
        return later;
    }
    let (mut copy, mut shift) = (text.to_owned(), 0);
    let start = first.changes.first().map_or(0, |(range, _)| range.start);
    let mut last = apply(first, &mut copy, &mut shift);
    for _ in 0..(MOST_BYTES / text.len().max(1)).min(MOST) {
        let mut sources = Sources::new();
        let file = sources.add("", &copy);
        let source = sources.file(file);
        let Some(error) = yaml::read(&copy, file, dialect.has_aliases).error else {
            later.is_meant &= later.edits.is_empty() || problems_left(&copy, dialect) == Some(0);
            return later;
        };
        let same: Ways<'_> = &|line, text, source, dialect| {
            let mut edits = ways(line, text, source, dialect);
            let is_later = |edit: &Edit| edit.changes.iter().all(|(range, _)| range.start > last);
            edits.retain(|edit| discriminant(&edit.kind) == discriminant(&first.kind) && is_later(edit));
            edits
        };
        let Some(window) = window::around(&error, &copy, source) else { break };
        let read = |window: &Window| find_in(window, same, &error, &copy, source, dialect).filter(|best| best.is_sure);
        let in_parts = || parts(&window, &error, &copy, source, dialect).find_map(|part| read(&part));
        let Some(best) = read(&window).or_else(in_parts) else { break };
        if best.edit.changes.iter().any(|(range, _)| range.start >= reach(&(start..last), &copy)) {
            break;
        }
        later.is_meant &= best.is_meant;
        let mut edit = best.edit;
        let moved_by = shift;
        last = apply(&edit, &mut copy, &mut shift);
        for (range, _) in &mut edit.changes {
            *range = range.start.saturating_add_signed(-moved_by)..range.end.saturating_add_signed(-moved_by);
        }
        later.edits.push(edit);
    }
    later.is_meant = false;
    later
}

/// Applies a change to a copy. Returns the end of the change in it, and counts how far the rest has moved.
fn apply(edit: &Edit, copy: &mut String, shift: &mut isize) -> usize {
    let mut end = 0;
    let before = copy.len();
    for (range, with) in edit.changes.iter().rev() {
        copy.replace_range(range.clone(), with);
        end = end.max(range.end);
    }
    let moved = copy.len() as isize - before as isize;
    *shift += moved;
    end.saturating_add_signed(moved)
}

/// Whether several lines may have a mistake of this kind for the same reason. Words are not removed in many lines.
fn is_repeatable(kind: &Kind) -> bool {
    !matches!(
        kind,
        Kind::Surplus(_)
            | Kind::Indent(..)
            | Kind::Quote(_)
            | Kind::Unquoted(_)
            | Kind::Partner(..)
            | Kind::Open(..)
            | Kind::Nameless(_)
    )
}
