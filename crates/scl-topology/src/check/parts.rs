//! The check of files that become groups, each by itself, and of all files together.
//!
//! What is wrong in such a file is told once, in the words of that file, although its components exist in several
//! groups under other names.

use super::control::NO_EFFECT;
use super::{Facts, check};
use crate::diagnostic::{Diagnostic, Diagnostics, Severity};
use crate::model::Model;
use crate::source::{FileId, Sources, Span};
use crate::topology::Topology;
use std::collections::HashSet;

/// Checks a system. `parts` are the files that become groups, and `problems` what is known to be wrong already.
///
/// Returns no topology if there is an error, and all problems, sorted by position.
pub fn check_with_parts(
    model: &Model,
    parts: &[Model],
    facts: &Facts,
    sources: &Sources,
    mut problems: Diagnostics,
) -> (Option<Topology>, Vec<Diagnostic>) {
    let (mut known, mut of_parts) = (Known::of(parts), Diagnostics::new());
    let mut before: Vec<Diagnostic> = Vec::new();
    problems.retain(|problem| {
        before.extend(known.at(problem).map(|_| problem.clone()));
        true
    });
    for part in parts {
        let found = check_part(part, &before, &known, facts, sources);
        known.add_all(&found);
        of_parts.extend(found);
    }
    let topology = check(model, facts, sources, &mut problems);
    let has_errors = of_parts.has_errors();
    let is_before = |problem: &Diagnostic| before.iter().any(|known| is_same(known, problem));
    problems.retain(|problem| !known.repeats(problem) || is_before(problem));
    of_parts.append(problems);
    (topology.filter(|_| !has_errors), of_parts.into_sorted())
}

fn is_same(one: &Diagnostic, other: &Diagnostic) -> bool {
    one.code() == other.code() && one.primary.as_ref().map(|it| it.span) == other.primary.as_ref().map(|it| it.span)
}

/// Removes from what is found in all files together what is known of the `parts`, of which these are the problems.
pub fn without_repeats(found: &mut Diagnostics, of_parts: &mut Diagnostics, parts: &[Model]) {
    let mut known = Known::of(parts);
    of_parts.retain(|problem| {
        known.add(problem);
        true
    });
    found.retain(|problem| !known.repeats(problem));
}

/// What is wrong in a part, without what is `known` of the parts in it. `before` are the problems of all parts that are
/// told already.
fn check_part(part: &Model, before: &[Diagnostic], known: &Known, facts: &Facts, sources: &Sources) -> Vec<Diagnostic> {
    let mut found = Diagnostics::new();
    // Some rules pass over what another one has reported.
    found.extend(before.iter().cloned());
    check(part, facts, sources, &mut found);
    let exported = exported(part);
    found.retain(|problem| {
        // What is about the outside is known only there.
        let at = problem.primary.as_ref().map(|label| label.span);
        let is_open = problem.severity != Severity::Error && at.is_some_and(|at| exported.contains(&at));
        let is_told = known.repeats(problem) || before.iter().any(|known| is_same(known, problem));
        !is_open && !is_told && problem.code() != NO_EFFECT.code
    });
    found.into_sorted()
}

/// What is wrong in the files that become groups.
struct Known {
    files: HashSet<FileId>,
    told: HashSet<(&'static str, Span)>,
    /// The files with errors.
    wrong: HashSet<FileId>,
}

impl Known {
    fn of(parts: &[Model]) -> Self {
        Self { files: files(parts), told: HashSet::new(), wrong: HashSet::new() }
    }

    fn add_all(&mut self, problems: &[Diagnostic]) {
        problems.iter().for_each(|problem| self.add(problem));
    }

    fn add(&mut self, problem: &Diagnostic) {
        if let Some((code, at)) = self.at(problem) {
            self.told.insert((code, at));
            if problem.severity == Severity::Error {
                self.wrong.insert(at.file);
            }
        }
    }

    /// The rule and the place of a problem in one of the files.
    fn at(&self, problem: &Diagnostic) -> Option<(&'static str, Span)> {
        let at = problem.primary.as_ref()?.span;
        self.files.contains(&at.file).then(|| (problem.code(), at))
    }

    /// Whether a problem repeats one of a part, or may follow from it.
    fn repeats(&self, problem: &Diagnostic) -> bool {
        self.at(problem).is_some_and(|(code, at)| self.wrong.contains(&at.file) || self.told.contains(&(code, at)))
    }
}

/// The places of the gates that a file exports.
fn exported(part: &Model) -> HashSet<Span> {
    let ends: HashSet<&str> = part.exports.iter().map(|export| export.gate.value.as_str()).collect();
    let gates = part.components.iter().flat_map(|component| {
        component
            .gates
            .iter()
            .filter(|gate| ends.contains(format!("{}.{}", component.name.value, gate.name.value).as_str()))
    });
    gates.flat_map(|gate| [gate.name.span, gate.span, gate.kind.span]).collect()
}

/// The files with what is declared in groups.
fn files(parts: &[Model]) -> HashSet<FileId> {
    let declared = |part: &Model| {
        let owners = part.components.iter().chain(&part.kinds).map(|owner| owner.span);
        let connections = part.connections.iter().map(|connection| connection.span);
        let exports = part.exports.iter().map(|export| export.name.span);
        let controls = part.controls.iter().map(|control| control.text.span);
        let places = owners.chain(connections).chain(exports).chain(controls);
        places.map(|at| at.file).collect::<HashSet<_>>()
    };
    parts.iter().flat_map(declared).collect()
}
