//! Each entry does what it says.

use super::{ALL, explain, page};
use crate::cases::flow;
use crate::check::testing::{USUAL, problems};
use crate::diagnostic::{Diagnostic, Rule, Severity};

/// The messages that the schemas of examples declare.
const MESSAGES: [&str; 3] = ["uav.Command", "uav.Measurement", "uav.Status"];

fn found(text: &str) -> Vec<Diagnostic> {
    problems(text, text.contains("schemas:").then_some(&MESSAGES[..])).0
}

/// What an example has besides what it shows: small files are not whole systems.
fn is_companion(found: &Diagnostic, rule: &Rule) -> bool {
    found.severity == Severity::Lint || USUAL.contains(&found.code()) && rule.code != found.code()
}

fn topologies() -> impl Iterator<Item = &'static Rule> {
    // The loader reads the schemas of SCL0406; here no file exists.
    ALL.iter().copied().filter(|rule| rule.has_topology() && rule.code != "SCL0406")
}

#[test]
fn every_rule_has_a_code_of_its_own_and_an_explanation() {
    assert!(ALL.windows(2).all(|pair| pair[0].code < pair[1].code));
    for rule in ALL.iter() {
        let sentences = rule.explanation.matches(['.', '?']).count();
        assert!((2..=12).contains(&sentences) && rule.explanation.len() < 700, "{}", rule.code);
        assert!(!rule.title.ends_with('.') && rule.title.len() < 80, "{}", rule.code);
        let is_diff = rule.example.lines().all(|line| line.starts_with([' ', '-', '+']));
        assert!(is_diff && (rule.example.is_empty() || rule.example.ends_with('\n')), "{}", rule.code);
        assert!(!rule.example.is_empty() || explain(rule.code).is_some());
    }
}

#[test]
fn a_bad_example_has_its_problem_and_no_other() {
    for rule in topologies() {
        let bad = rule.bad_example();
        let spellings = [bad.clone(), bad.replace('\n', "\r\n"), bad.trim_end().to_owned()];
        for text in spellings.into_iter().chain(flow::of(&bad)) {
            let found = found(&text);
            assert!(found.iter().any(|found| found.code() == rule.code), "{} is not found in {text:?}", rule.code);
            let other = found.iter().find(|found| found.code() != rule.code && !is_companion(found, rule));
            assert!(other.is_none(), "{}: {other:?} in {text:?}", rule.code);
            let severity = found.iter().find(|found| found.code() == rule.code).map(|found| found.severity);
            let is_asked_for = text.contains(&format!("warn({}", rule.code));
            assert!(severity == Some(rule.severity) || is_asked_for, "{}", rule.code);
        }
    }
}

#[test]
fn a_good_example_has_no_problem() {
    for rule in topologies() {
        let good = rule.good_example();
        let found = found(&good);
        let problem = found
            .iter()
            .find(|found| found.code() == rule.code || found.severity == Severity::Error && found.code() != "SCL0703");
        assert!(problem.is_none(), "{}: {problem:?} in {good}", rule.code);
    }
}

#[test]
fn the_page_in_the_repository_is_up_to_date() {
    expect_test::expect_file!["../../../../docs/diagnostics.md"].assert_eq(&page());
}
