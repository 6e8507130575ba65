//! The trial of advice: every proposal is applied to a copy of the text, and the copy is checked.
//!
//! A proposal is kept if its own problem is gone and no other problem is new. What is left is what tools show, and
//! `scl check --fix` applies those that are sure.

mod compare;
mod edit;
mod extent;

use crate::diagnostic::{Diagnostic, Edit, MOST_LISTED, Severity, first};
use crate::source::{FileId, SourceFile, Sources};
use compare::{Change, passes};
use std::collections::BTreeMap;

pub(crate) use compare::reach;
pub use edit::apply;
pub use extent::Extent;

/// Maximum number of copies of a file that are checked.
const MOST_TRIES: usize = 20;

/// Maximum size of all these copies in bytes, with the files that belong to them; one copy may always be checked.
const MOST_BYTES: usize = 1 << 20;

/// Maximum number of problems of a file whose advice is tried: to compare more costs as much as to find them.
const MOST_COMPARED: usize = 10_000;

/// The result of checking a text.
pub struct Judged {
    /// Its problems, sorted by position.
    pub problems: Vec<Diagnostic>,
    /// How much of it could be read.
    pub extent: Extent,
}

/// A copy of a file, with the changes of one or several proposals.
#[derive(Debug)]
pub struct ChangedCopy {
    /// The file.
    pub file: FileId,
    /// Its changed text.
    pub text: String,
}

impl ChangedCopy {
    /// The files, with copies in place of some of them.
    pub fn replace_in(copies: &[Self], sources: &Sources) -> Sources {
        copies.iter().fold(sources.clone(), |sources, copy| sources.with_text(copy.file, &*copy.text))
    }
}

/// Applies every proposal of the `found` problems to a copy of the file, has the copy checked by `judge`, and removes
/// the proposals that leave their problem or add another.
///
/// At most 20 copies of together 1 MiB are checked. If there are more proposals, many are tried at once. Those that
/// could not be tried are removed: among them those of problems after the first [`MOST_LISTED`], which no tool shows,
/// and all of a file with more than 10,000 problems. Lints are off, so their proposals are kept untried, and none of
/// them is sure.
pub fn try_advice(found: &mut Judged, source: &SourceFile, mut judge: impl FnMut(&str) -> Judged) {
    // A copy of nothing is never tried.
    try_advice_in_files(found, &[source], |copies| judge(copies.first().map_or("", |copy| &copy.text)));
}

/// As [`try_advice`], for problems of several files that belong together. `judge` checks all of them, with copies in
/// place of those that a proposal changes.
pub fn try_advice_in_files(found: &mut Judged, files: &[&SourceFile], judge: impl FnMut(&[ChangedCopy]) -> Judged) {
    let tries = tries(files.iter().map(|file| file.text().len()).sum());
    let shown = shown(&found.problems);
    let candidates = candidates(&found.problems, &shown);
    let mut trial = Trial { before: found, files, tries, judge };
    let mut passed = vec![false; candidates.len()];
    match candidates.len() <= tries {
        true => candidates.iter().enumerate().for_each(|(at, way)| passed[at] = trial.try_together(&[way])),
        false => trial.try_many(&candidates, &mut passed),
    }
    let mut results = passed.into_iter();
    for (number, problem) in found.problems.iter_mut().enumerate().filter(|(_, problem)| is_tried(problem)) {
        let is_shown = shown.binary_search(&number).is_ok();
        problem.keep_proposals(|| is_shown && results.next().unwrap_or(false));
    }
}

/// Number of copies of a text of this length that may be checked.
pub(crate) fn tries(length: usize) -> usize {
    (MOST_BYTES / length.max(1)).clamp(1, MOST_TRIES)
}

fn is_tried(problem: &Diagnostic) -> bool {
    problem.severity != Severity::Lint
}

/// The numbers of the problems whose advice is tried, in ascending order.
fn shown(problems: &[Diagnostic]) -> Vec<usize> {
    if problems.len() > MOST_COMPARED {
        return Vec::new();
    }
    let tried = problems.iter().enumerate().filter(|(_, problem)| is_tried(problem));
    let is_shown = first(tried.clone().map(|(_, problem)| problem), MOST_LISTED);
    tried.zip(is_shown).filter(|(_, is_shown)| *is_shown).map(|((number, _), _)| number).collect()
}

/// One proposal, and the number of its problem.
struct Candidate<'p> {
    problem: usize,
    edits: &'p [Edit],
}

fn candidates<'p>(problems: &'p [Diagnostic], shown: &[usize]) -> Vec<Candidate<'p>> {
    let ways =
        |&problem: &usize| problems[problem].proposals().map(move |way| Candidate { problem, edits: &way.edits });
    shown.iter().flat_map(ways).collect()
}

struct Trial<'t, J> {
    before: &'t Judged,
    files: &'t [&'t SourceFile],
    /// The number of copies that may still be checked.
    tries: usize,
    judge: J,
}

impl<J: FnMut(&[ChangedCopy]) -> Judged> Trial<'_, J> {
    /// Whether candidates of different problems pass when they are applied together.
    fn try_together(&mut self, candidates: &[&Candidate<'_>]) -> bool {
        let edits: Vec<&Edit> = candidates.iter().flat_map(|candidate| candidate.edits).collect();
        let Some(copies) = self.copies(&edits) else { return false };
        let Some(left) = self.tries.checked_sub(1) else { return false };
        self.tries = left;
        let after = (self.judge)(&copies);
        let problems = candidates.iter().map(|candidate| candidate.problem).collect();
        passes(self.before, &Change { problems, edits: &edits, copies: &copies }, &after)
    }

    /// The files that change, with the changes applied. `None` if nothing changes, if changes overlap, or if one lies
    /// in another file.
    fn copies(&self, edits: &[&Edit]) -> Option<Vec<ChangedCopy>> {
        let mut by_file: BTreeMap<FileId, Vec<&Edit>> = BTreeMap::new();
        edits.iter().for_each(|edit| by_file.entry(edit.span.file).or_default().push(edit));
        let (mut copies, mut is_changed) = (Vec::new(), false);
        for (file, edits) in by_file {
            let text = self.files.iter().find(|source| source.id() == file)?.text();
            let copy = apply(text, &edits)?;
            is_changed |= copy != text;
            copies.push(ChangedCopy { file, text: copy });
        }
        is_changed.then_some(copies)
    }

    /// Tries the first proposals of all problems at once, then the second ones, and so on. If such a group does not
    /// pass, its halves are tried.
    fn try_many(&mut self, candidates: &[Candidate<'_>], passed: &mut [bool]) {
        let mut rounds: Vec<Vec<usize>> = Vec::new();
        let mut number = 0;
        for (at, candidate) in candidates.iter().enumerate() {
            let is_next = at > 0 && candidates[at - 1].problem == candidate.problem;
            number = if is_next { number + 1 } else { 0 };
            if rounds.len() == number {
                rounds.push(Vec::new());
            }
            rounds[number].push(at);
        }
        // The halves of a round are tried before the next round.
        let mut groups: Vec<Vec<usize>> = rounds.into_iter().rev().collect();
        while let Some(mut group) = groups.pop().filter(|_| self.tries > 0) {
            let together: Vec<&Candidate<'_>> = group.iter().map(|&at| &candidates[at]).collect();
            if self.try_together(&together) {
                group.into_iter().for_each(|at| passed[at] = true);
            } else if group.len() > 1 {
                let second = group.split_off(group.len() / 2);
                groups.extend([second, group]);
            }
        }
    }
}

#[cfg(test)]
mod tests;
