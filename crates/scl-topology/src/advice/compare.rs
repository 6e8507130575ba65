//! Compares the problems of a file before and after a change.

use super::edit::{is_crlf, sorted};
use super::{Extent, Judged};
use crate::diagnostic::{Diagnostic, Edit, Label, Severity};
use std::collections::HashMap;
use std::ops::Range;

/// What identifies a problem in two versions of a file: its rule and its headline.
type Key<'p> = (&'static str, &'p str);

/// The problems of a file before a change.
pub(super) struct Before<'b> {
    problems: &'b [Diagnostic],
    counts: HashMap<Key<'b>, usize>,
    extent: Extent,
    is_crlf: bool,
}

impl<'b> Before<'b> {
    pub(super) fn of(judged: &'b Judged, text: &str) -> Self {
        let problems = judged.problems.as_slice();
        Self { problems, counts: counts(problems), extent: judged.extent, is_crlf: is_crlf(text) }
    }
}

fn key(problem: &Diagnostic) -> Key<'_> {
    (problem.code(), &problem.message)
}

fn counts(problems: &[Diagnostic]) -> HashMap<Key<'_>, usize> {
    let mut counts = HashMap::new();
    problems.iter().for_each(|problem| *counts.entry(key(problem)).or_default() += 1);
    counts
}

/// What is tried.
pub(super) struct Change<'c> {
    /// The numbers of the problems that it should solve.
    pub(super) problems: Vec<usize>,
    pub(super) edits: &'c [&'c Edit],
}

impl Change<'_> {
    /// Whether it removes words and writes no others.
    fn is_removal(&self) -> bool {
        self.edits.iter().any(|edit| edit.replacement.is_empty())
    }
}

/// Whether a change solves its problems without adding any. `copy` is the changed text, and `after` what was found in
/// it.
///
/// If a file can be read further than before, problems that were there before may show outside of the changed lines and
/// what belongs to them. This does not hold for a removal, which could hide one mistake and make another.
pub(super) fn passes(before: &Before<'_>, change: &Change<'_>, after: &Judged, copy: &str) -> bool {
    if after.extent.is_cut_off && !before.extent.is_cut_off {
        return false;
    }
    let own: Vec<&Diagnostic> = change.problems.iter().map(|number| &before.problems[*number]).collect();
    let reads_further = before.extent.is_cut_off || after.extent.unread < before.extent.unread;
    let block = block(&changed(change.edits, before.is_crlf, copy), copy);
    let is_elsewhere = |label: &Label| match label.span.start as usize {
        at if after.extent.is_cut_off => at >= block.end,
        at => !block.contains(&at),
    };
    let is_revealed = |problem: &Diagnostic| {
        let mut labels = problem.primary.iter().chain(&problem.secondary);
        !change.is_removal() && reads_further && problem.primary.is_some() && labels.all(is_elsewhere)
    };
    let worst = own.iter().map(|problem| problem.severity).max().unwrap_or(Severity::Error);

    let mut left = counts(&after.problems);
    after.problems.iter().filter(|problem| is_revealed(problem)).for_each(|problem| {
        // A problem that was known before is not revealed.
        if let Some(count) = left.get_mut(&key(problem)).filter(|count| **count > before.count(problem)) {
            *count -= 1;
        }
    });
    // For each rule, the number of problems that must go, and of those that did.
    let mut balance: HashMap<&str, isize> = HashMap::new();
    own.iter().for_each(|problem| *balance.entry(problem.code()).or_default() += 1);
    for (key, count) in &before.counts {
        let gone = count.saturating_sub(left.get(key).copied().unwrap_or_default());
        *balance.entry(key.0).or_default() -= gone as isize;
    }
    let mut told: HashMap<Key<'_>, usize> = before.counts.clone();
    for problem in after.problems.iter().filter(|problem| problem.severity <= worst && !is_revealed(problem)) {
        match told.get_mut(&key(problem)).filter(|count| **count > 0) {
            Some(count) => *count -= 1,
            None => *balance.entry(problem.code()).or_default() += 1,
        }
    }
    own.iter().all(|problem| left.get(&key(problem)).copied().unwrap_or_default() < before.count(problem))
        && balance.values().all(|missing| *missing <= 0)
}

impl Before<'_> {
    fn count(&self, problem: &Diagnostic) -> usize {
        self.counts.get(&key(problem)).copied().unwrap_or_default()
    }
}

/// The bytes of a copy from the first change to the end of the last.
fn changed(edits: &[&Edit], is_crlf: bool, copy: &str) -> Range<usize> {
    let mut shift = 0_isize;
    let mut changed: Option<Range<usize>> = None;
    for edit in sorted(edits) {
        let breaks = if is_crlf { edit.replacement.matches('\n').count() } else { 0 };
        let length = edit.replacement.len() + breaks;
        let start = edit.span.start.saturating_add_signed(shift as i32) as usize;
        shift += length as isize - (edit.span.end - edit.span.start) as isize;
        let from = changed.map_or(start, |changed| changed.start);
        changed = Some(from..start + length);
    }
    let Range { start, end } = changed.unwrap_or_default();
    start.min(copy.len())..end.min(copy.len())
}

/// The lines of a change, and those below that belong to them because they are indented further, or are the list of the
/// last key.
fn block(changed: &Range<usize>, copy: &str) -> Range<usize> {
    let line_start = |at: usize| copy.get(..at).and_then(|before| before.rfind('\n')).map_or(0, |at| at + 1);
    let start = line_start(changed.start);
    let mut end = line_start(changed.end);
    let mut head: Option<(usize, bool)> = None;
    for line in copy.get(end..).unwrap_or_default().split_inclusive('\n') {
        let content = line.trim_start_matches(' ');
        let (indent, is_item) = (line.len() - content.len(), content.starts_with('-'));
        let belongs = match head {
            None => true,
            Some(_) if content.trim().is_empty() => true,
            Some((of, of_item)) => indent > of || indent == of && is_item && !of_item,
        };
        if !belongs {
            break;
        }
        head.get_or_insert((indent, is_item));
        end += line.len();
    }
    start..end
}
