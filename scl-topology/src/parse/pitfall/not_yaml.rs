//! SCL0121: a syntax error that no other rule explains.

use super::Place;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::Severity;
use crate::parse::{component, sections};
use crate::rule::{Examples, Rule};
use crate::yaml::SyntaxError;
use std::ops::Range;

/// SCL0121.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0121",
    severity: Severity::Error,
    title: "text that is not YAML",
    explanation: "The text is no YAML, and none of the more exact rules knows why. The place is where the parser gave \
                  up; the mistake stands there or shortly before. Compare the lines with those of a sound file.",
    examples: Examples::Topology {
        bad: "components
  - name: sensor
    gates: []
",
        good: "components:
  - name: sensor
    gates: []
",
    },
};

pub(super) fn diagnose(error: &SyntaxError, place: &Place<'_>) -> Diagnostic {
    if let Some(problem) = missing_colon(error, place) {
        return problem;
    }
    let text = place.source.text();
    let mut at = error.at;
    while at > 0 && !text.is_char_boundary(at) {
        at -= 1;
    }
    let end = at + text[at..].chars().next().filter(|c| !c.is_control()).map_or(0, char::len_utf8);
    let words = error.words.rsplit(", ").next().unwrap_or(&error.words);
    RULE.at(format!("this is not valid YAML: {words}"), place.span(at..end), "the parser stops here")
        .help("the mistake is here or shortly before")
}

/// A section or key without its colon, in the line of the error or the one before.
fn missing_colon(error: &SyntaxError, place: &Place<'_>) -> Option<Diagnostic> {
    let (start, word) = here_and_above(error, place).find_map(|line| {
        let content = &place.source.text()[line.clone()];
        let content = content.trim_start_matches([' ', '-']);
        let word = content.split([' ', '#']).next().filter(|word| is_key(word))?;
        Some((line.end - content.len(), word))
    })?;
    Some(
        RULE.at(format!("missing `:` after `{word}`"), place.span(start..start + word.len()), "a key")
            .help(format!("write `{word}:`")),
    )
}

/// The line of the error and the one above it.
fn here_and_above(error: &SyntaxError, place: &Place<'_>) -> impl Iterator<Item = Range<usize>> {
    let here = place.line_range(error.at);
    let above = here.start.checked_sub(1).map(|at| place.line_range(at));
    std::iter::once(here).chain(above)
}

/// `-sensor` or `-- sensor` where `- sensor` is meant.
pub(super) fn missing_dash_space(error: &SyntaxError, place: &Place<'_>) -> Option<Diagnostic> {
    let (start, dashes, rest) = here_and_above(error, place).find_map(|line| {
        let word = place.source.text()[line.clone()].trim_start_matches(' ');
        let rest = word.trim_start_matches('-');
        let dashes = word.len() - rest.len();
        let starts_word = rest.trim_start().starts_with(|c: char| c.is_alphabetic() || c == '[');
        let is_odd = dashes == 2 || dashes == 1 && !rest.starts_with(' ');
        (starts_word && is_odd).then_some((line.end - word.len(), dashes, rest.trim()))
    })?;
    let message = if dashes == 1 { "missing space after `-`" } else { "a list item starts with one `-`, not with two" };
    let span = place.span(start..start + dashes);
    Some(RULE.at(message, span, "starts no list item").help(format!("write `- {rest}`")))
}

fn is_key(word: &str) -> bool {
    sections::SECTIONS.contains(&word) || component::KEYS.contains(&word)
}
