//! Which fixes are applied together, and how.

use scl_loader::Loaded;
use scl_topology::advice;
use scl_topology::diagnostic::{Diagnostic, Edit, Severity};
use scl_topology::source::FileId;
use std::collections::{BTreeMap, HashSet};
use std::ops::Range;

pub(super) const BYTE_ORDER_MARK: &str = "\u{feff}";

/// The sure proposal of one problem.
pub(super) struct FixGroup {
    /// The headline of the problem with its code.
    pub(super) problem: String,
    edits: Vec<Edit>,
}

/// Returns the fixes of a file that can be applied together: only the first of those that overlap, and none for
/// `refused` problems.
pub(super) fn groups(loaded: &Loaded, file: FileId, refused: &HashSet<String>) -> Vec<FixGroup> {
    let mut taken: BTreeMap<usize, usize> = BTreeMap::new();
    let problems = loaded.diagnostics.iter().filter(|found| found.severity != Severity::Lint);
    problems
        .filter_map(|problem| group(problem, file))
        .filter(|group| !refused.contains(&group.problem))
        .filter(|group| {
            let is_free = group.edits.iter().all(|edit| is_free(&taken, &range(edit)));
            taken.extend(group.edits.iter().filter(|_| is_free).map(|edit| (range(edit).start, range(edit).end)));
            is_free
        })
        .collect()
}

/// Returns the text with the fixes applied. Line breaks in the fixes are converted to those of the text.
pub(super) fn apply(text: &str, groups: &[FixGroup]) -> String {
    // Spans do not count the byte order mark.
    let (mark, text) = text.split_at(if text.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 });
    let edits: Vec<&Edit> = groups.iter().flat_map(|group| &group.edits).collect();
    let fixed = advice::apply(text, &edits);
    debug_assert!(fixed.is_some(), "the fixes of a file overlap");
    format!("{mark}{}", fixed.as_deref().unwrap_or(text))
}

fn group(problem: &Diagnostic, file: FileId) -> Option<FixGroup> {
    let sure = problem.proposals().find(|proposal| proposal.is_sure)?;
    let is_here = sure.edits.iter().all(|edit| edit.span.file == file);
    let problem = format!("{} {}", problem.code(), problem.message);
    is_here.then(|| FixGroup { problem, edits: sure.edits.clone() })
}

/// Whether a span neither overlaps nor touches any that is taken, so that the order of two insertions never matters.
fn is_free(taken: &BTreeMap<usize, usize>, span: &Range<usize>) -> bool {
    taken.range(..=span.end).next_back().is_none_or(|(_, end)| *end < span.start)
}

fn range(edit: &Edit) -> Range<usize> {
    edit.span.start as usize..edit.span.end as usize
}
