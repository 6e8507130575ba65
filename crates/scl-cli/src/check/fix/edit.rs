//! Which fixes are applied together, and how.

use scl_loader::Loaded;
use scl_topology::diagnostic::{Diagnostic, Fix, Severity};
use scl_topology::source::FileId;
use std::collections::{BTreeMap, HashSet};
use std::ops::Range;

pub(super) const BYTE_ORDER_MARK: &str = "\u{feff}";

/// The sure fixes of one problem, which are applied together or not at all.
pub(super) struct FixGroup {
    /// The headline of the problem with its code.
    pub(super) problem: String,
    /// Replaced ranges with their replacements, sorted by position.
    edits: Vec<(Range<usize>, String)>,
}

/// Returns the fixes of a file that can be applied together: only the first of those that overlap, and none for
/// `refused` problems.
pub(super) fn groups(loaded: &Loaded, refused: &HashSet<String>) -> Vec<FixGroup> {
    let Some(file) = loaded.file else { return Vec::new() };
    let mut taken: BTreeMap<usize, usize> = BTreeMap::new();
    let problems = loaded.diagnostics.iter().filter(|found| found.severity != Severity::Lint);
    problems
        .filter_map(|problem| group(problem, file))
        .filter(|group| !refused.contains(&group.problem))
        .filter(|group| {
            let is_free = group.edits.iter().all(|(span, _)| is_free(&taken, span));
            taken.extend(group.edits.iter().filter(|_| is_free).map(|(span, _)| (span.start, span.end)));
            is_free
        })
        .collect()
}

/// Returns the text with the fixes applied. Line breaks in the fixes are converted to those of the text.
pub(super) fn apply(text: &str, groups: &[FixGroup]) -> String {
    let line_break = if is_crlf(text) { "\r\n" } else { "\n" };
    // Spans do not count the byte order mark.
    let (mark, text) = text.split_at(if text.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 });
    let mut edits: Vec<&(Range<usize>, String)> = groups.iter().flat_map(|group| &group.edits).collect();
    edits.sort_by_key(|(span, _)| span.start);
    let mut out = mark.to_owned();
    let mut at = 0;
    for (span, replacement) in edits {
        out.push_str(&text[at..span.start]);
        out.push_str(&replacement.replace('\n', line_break));
        at = span.end;
    }
    out + &text[at..]
}

fn group(problem: &Diagnostic, file: FileId) -> Option<FixGroup> {
    let sure: Vec<&Fix> = problem.fixes.iter().filter(|fix| fix.sure).collect();
    let is_here = sure.iter().all(|fix| fix.span.file == file);
    let mut edits: Vec<(Range<usize>, String)> =
        sure.into_iter().map(|fix| (fix.span.start as usize..fix.span.end as usize, fix.replacement.clone())).collect();
    edits.sort_by_key(|(span, _)| (span.start, span.end));
    let is_ordered = edits.windows(2).all(|pair| pair[0].0.end <= pair[1].0.start);
    let problem = format!("{} {}", problem.code(), problem.message);
    (is_here && is_ordered && !edits.is_empty()).then_some(FixGroup { problem, edits })
}

/// Whether a span neither overlaps nor touches any that is taken, so that the order of two insertions never matters.
fn is_free(taken: &BTreeMap<usize, usize>, span: &Range<usize>) -> bool {
    taken.range(..=span.end).next_back().is_none_or(|(_, end)| *end < span.start)
}

fn is_crlf(text: &str) -> bool {
    2 * text.matches("\r\n").count() > text.matches('\n').count()
}
