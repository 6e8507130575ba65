//! SCL0121: a syntax error that no other rule explains.

use super::Place;
use crate::catalogue::{Examples, Rule};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::Severity;
use crate::parse::{component, sections};
use crate::yaml::SyntaxError;

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

/// A lone section or key without its colon, in the line of the error or the one before.
fn missing_colon(error: &SyntaxError, place: &Place<'_>) -> Option<Diagnostic> {
    let here = place.line_range(error.at);
    let above = here.start.checked_sub(1).map(|at| place.line_range(at));
    let line = std::iter::once(here).chain(above).find(|line| is_lone_key(&place.source.text()[line.clone()]))?;
    let content = &place.source.text()[line.clone()];
    let word = content.trim_start_matches([' ', '-']);
    let start = line.end - word.len();
    let word = word.trim_end();
    Some(
        RULE.at(format!("missing `:` after `{word}`"), place.span(start..start + word.len()), "a key")
            .help(format!("write `{word}:`")),
    )
}

/// `-sensor` where `- sensor` is meant, in the line of the error.
pub(super) fn missing_dash_space(error: &SyntaxError, place: &Place<'_>) -> Option<Diagnostic> {
    let line = place.line_range(error.at);
    let content = &place.source.text()[line.clone()];
    let word = content.trim_start_matches(' ');
    let rest = word.strip_prefix('-').filter(|rest| rest.starts_with(|c: char| c.is_alphabetic() || c == '['))?;
    let start = line.end - word.len();
    Some(
        RULE.at("missing space after `-`", place.span(start..start + 1), "starts no list item")
            .help(format!("write `- {}`", rest.trim_end())),
    )
}

fn is_lone_key(line: &str) -> bool {
    let word = line.trim_start_matches([' ', '-']).trim_end();
    sections::SECTIONS.contains(&word) || component::KEYS.contains(&word)
}
