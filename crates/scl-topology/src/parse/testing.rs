//! Helpers for the tests of the rules.

use super::parse;
use crate::advice::{Extent, Judged, try_advice};
use crate::diagnostic::{Diagnostic, Diagnostics, Help, Rule, Severity, render};
use crate::model::Model;
use crate::source::Sources;
use expect_test::Expect;

/// Parses a text under the name `topology.yaml`; the problems are sorted by position.
pub(super) fn parse_text(text: &str) -> (Model, Vec<Diagnostic>, Sources) {
    let mut sources = Sources::new();
    let file = sources.add("topology.yaml", text);
    let judge = |sources: &Sources| {
        let mut problems = Diagnostics::new();
        let model = parse(sources, file, &mut problems);
        (Judged { problems: problems.into_sorted(), extent: Extent::of(&model) }, model)
    };
    let (mut found, model) = judge(&sources);
    try_advice(&mut found, sources.file(file), |copy| judge(&sources.with_text(file, copy)).0);
    (model, found.problems, sources)
}

/// Code, place and headline of a text's problems, one a line, sorted by position.
pub(super) fn headlines(text: &str) -> String {
    let (_, problems, sources) = parse_text(text);
    let line = |problem: &Diagnostic| {
        let place = problem.primary.as_ref().map_or(String::new(), |label| sources.place(label.span));
        format!("{} {} {}\n", problem.code(), place.trim_start_matches("topology.yaml:"), problem.message)
    };
    problems.iter().map(line).collect()
}

/// Headline and helps of each error of a text; a help that `--fix` applies begins with `!`.
pub(super) fn advice(text: &str) -> String {
    let (_, problems, _) = parse_text(text);
    let line = |problem: &Diagnostic| {
        let help = |help: &Help| match help.proposals.iter().any(|way| way.is_sure) {
            true => format!("!{}", help.text()),
            false => help.text().into_owned(),
        };
        let helps: Vec<String> = problem.shown_helps().map(help).collect();
        format!("{} {} [{}]", problem.code(), problem.message, helps.join(" | "))
    };
    problems.iter().filter(|problem| problem.severity == Severity::Error).map(line).collect::<Vec<_>>().join("; ")
}

/// Checks that the bad example of a rule gives its code, no other error, and these words, with either line end and with
/// a byte order mark.
#[track_caller]
pub(super) fn check(rule: &Rule, expected: Expect) {
    let text = rule.bad_example();
    assert!(rule.has_topology(), "{} has no example", rule.code);
    let code = rule.code;
    let spellings = [text.clone(), text.replace('\n', "\r\n"), format!("\u{feff}{text}")];
    let [plain, others @ ..] = spellings.map(|spelling| {
        let (_, problems, sources) = parse_text(&spelling);
        let other = problems.iter().find(|problem| problem.code() != code && problem.severity == Severity::Error);
        assert!(other.is_none(), "{other:?} in {spelling:?}");
        let texts: Vec<String> =
            problems.iter().filter(|problem| problem.code() == code).map(|problem| render(problem, &sources)).collect();
        texts.join("\n\n")
    });
    expected.assert_eq(&plain);
    others.iter().for_each(|other| assert_eq!(*other, plain));
}
