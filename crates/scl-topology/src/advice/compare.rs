//! Compares the problems of a file before and after a change.

use super::edit::{is_crlf, sorted};
use super::{ChangedCopy, Judged};
use crate::diagnostic::{Diagnostic, Edit, Label, Severity};
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// What identifies a problem in two versions of a file: its rule and its headline.
type Key<'p> = (&'static str, &'p str);

fn key(problem: &Diagnostic) -> Key<'_> {
    (problem.code(), &problem.message)
}

fn counts<'p>(problems: impl IntoIterator<Item = &'p Diagnostic>) -> HashMap<Key<'p>, usize> {
    let mut counts = HashMap::new();
    problems.into_iter().for_each(|problem| *counts.entry(key(problem)).or_default() += 1);
    counts
}

fn as_bad(judged: &Judged, worst: Severity) -> impl Iterator<Item = &Diagnostic> {
    judged.problems.iter().filter(move |problem| problem.severity <= worst)
}

/// What is tried.
pub(super) struct Change<'c> {
    /// The numbers of the problems that it should solve.
    pub(super) problems: Vec<usize>,
    pub(super) edits: &'c [&'c Edit],
    /// The files that they change.
    pub(super) copies: &'c [ChangedCopy],
}

impl Change<'_> {
    /// Whether it moves lines only: then all lines of a section may belong to others than before.
    fn is_indentation(&self) -> bool {
        self.edits.iter().all(|edit| edit.replacement.trim().is_empty())
    }

    /// The lines of a copy that it changes, and those that belong to them.
    fn block(&self, copy: &ChangedCopy) -> Range<usize> {
        let edits: Vec<&Edit> = self.edits.iter().copied().filter(|edit| edit.span.file == copy.file).collect();
        let changed = changed(&edits, is_crlf(&copy.text), &copy.text);
        if self.is_indentation() { section(&changed, &copy.text) } else { block(&changed, &copy.text) }
    }

    /// Whether it removes words and writes no others.
    fn is_removal(&self) -> bool {
        self.edits.iter().any(|edit| edit.replacement.is_empty())
    }
}

/// Whether a change solves its problems without adding any; `before` and `after` are what was found without and with
/// it.
///
/// If a file can be read further than before, problems that were there before may show outside of the changed lines and
/// what belongs to them. This does not hold for a removal, which could hide one mistake and make another.
pub(super) fn passes(before: &Judged, change: &Change<'_>, after: &Judged) -> bool {
    if after.extent.is_cut_off && !before.extent.is_cut_off {
        return false;
    }
    let reads_further = before.extent.is_cut_off || after.extent.unread < before.extent.unread;
    let may_reveal = reads_further && !change.is_removal();
    let blocks: Vec<(&ChangedCopy, Range<usize>)> =
        change.copies.iter().map(|copy| (copy, change.block(copy))).collect();
    let own = || change.problems.iter().map(|number| &before.problems[*number]);
    let own_rules: HashSet<&str> = own().map(Diagnostic::code).collect();
    let is_revealed = |problem: &Diagnostic| {
        let is_elsewhere = |label: &Label| {
            let Some((copy, block)) = blocks.iter().find(|(copy, _)| copy.file == label.span.file) else { return true };
            // The same mistake in the next line may be the same one, moved.
            let end = match own_rules.contains(problem.code()) {
                true => with_next_line(block.end, &copy.text),
                false => block.end,
            };
            match label.span.start as usize {
                at if after.extent.is_cut_off => at >= end,
                at => !(block.start..end).contains(&at),
            }
        };
        let mut labels = problem.primary.iter().chain(&problem.secondary);
        may_reveal && problem.primary.is_some() && labels.all(is_elsewhere)
    };
    // A change that solves an error may leave the file with a warning.
    let worst = own().map(|problem| problem.severity).max().unwrap_or(Severity::Error);
    let (known, own) = (counts(as_bad(before, worst)), counts(own()));
    let all = counts(as_bad(after, worst));
    let mut told = counts(as_bad(after, worst).filter(|problem| !is_revealed(problem)));
    for (key, count) in &known {
        // What was told before, apart from the own problems, is not revealed.
        let others = (count - own.get(key).unwrap_or(&0)).min(*all.get(key).unwrap_or(&0));
        let told = told.entry(*key).or_default();
        *told = (*told).max(others);
    }
    let is_solved = own.iter().all(|(key, count)| told[key] + count <= known[key]);
    // Another problem may be told in other words, which contain a name that was changed.
    let mut balance: HashMap<&str, isize> = HashMap::new();
    for (key, count) in told {
        *balance.entry(key.0).or_default() += count as isize - *known.get(&key).unwrap_or(&0) as isize;
    }
    own.iter().for_each(|(key, count)| *balance.entry(key.0).or_default() += *count as isize);
    is_solved && balance.values().all(|added| *added <= 0)
}

/// The end of the part of a text in which a problem like the one that a change has solved may be the same one, moved.
pub(crate) fn reach(changed: &Range<usize>, copy: &str) -> usize {
    with_next_line(block(changed, copy).end, copy)
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

/// The lines of the top-level keys around a change.
fn section(changed: &Range<usize>, copy: &str) -> Range<usize> {
    let is_top = |line: &str| line.starts_with(|letter: char| !letter.is_whitespace() && !matches!(letter, '-' | '#'));
    let above = copy.get(..changed.start).unwrap_or_default().split_inclusive('\n').rev();
    let mut start = changed.start;
    for line in above {
        start -= line.len();
        if is_top(line) {
            break;
        }
    }
    let mut below = copy.get(changed.end..).unwrap_or_default().split_inclusive('\n');
    let rest = below.next().map_or(0, str::len);
    start..changed.end + rest + below.take_while(|line| !is_top(line)).map(str::len).sum::<usize>()
}

/// The end of the first line with content after some bytes.
fn with_next_line(at: usize, copy: &str) -> usize {
    let lines = copy.get(at..).unwrap_or_default().split_inclusive('\n');
    let mut end = at;
    for line in lines {
        end += line.len();
        if !line.trim().is_empty() {
            break;
        }
    }
    end
}
