//! SCL0102: brackets that do not match.

use super::{Place, scan};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::Severity;
use crate::rule::{Examples, Rule};
use crate::yaml::SyntaxError;
use std::ops::Range;

/// SCL0102.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0102",
    severity: Severity::Error,
    title: "bracket never closed",
    explanation: "A bracket or brace has no partner, or one of the other kind. The place shown is the bracket itself, \
                  not the far end of the file where a parser notices it. Add or correct the missing one.",
    examples: Examples::Topology {
        bad: "connections:
  - [sensor.measurements, controller.sensor
  - [controller.actuator, actuator.setpoint]
",
        good: "components: []
connections: []
",
    },
};

/// A bracket problem that the parser noticed as such.
pub(super) fn find(error: &SyntaxError, text: &str, place: &Place<'_>) -> Option<Diagnostic> {
    match text.as_bytes().get(error.at) {
        Some(b'[' | b'{') => Some(match wrong_close(error.at, text, place) {
            Some(close) => mismatched(error.at, close, text, place),
            None => never_closed(error.at, text, place),
        }),
        Some(b']' | b'}') if scan::scan(&text[..error.at]).open_brackets.is_empty() => {
            Some(never_opened(error.at, text, place))
        }
        _ => find_open(error, text, place),
    }
}

/// The bracket of the other kind that stands where the closing one belongs, in the same line.
fn wrong_close(open: usize, text: &str, place: &Place<'_>) -> Option<usize> {
    let inside = &text[open + 1..place.line_range(open).end];
    let at = inside.find(['[', ']', '{', '}'])?;
    let right = closing(&text[open..open + 1]);
    let found = inside[at..].chars().next()?;
    (matches!(found, ']' | '}') && found != right).then_some(open + 1 + at)
}

/// A bracket that is open where the parser stops.
pub(super) fn find_open(error: &SyntaxError, text: &str, place: &Place<'_>) -> Option<Diagnostic> {
    let open = scan::scan(text.get(..error.at)?).open_brackets.pop()?;
    match text.as_bytes().get(error.at) {
        Some(b']' | b'}') => Some(mismatched(open, error.at, text, place)),
        _ => Some(never_closed(open, text, place)),
    }
}

fn never_closed(open: usize, text: &str, place: &Place<'_>) -> Diagnostic {
    let bracket = &text[open..open + 1];
    let next = next_item(open, text, place);
    let inside = &text[open + 1..next.as_ref().map_or(text.len(), |item| item.start)];
    let mut problem = RULE.at(format!("this `{bracket}` is never closed"), place.span(open..open + 1), "opened here");
    if let Some(item) = next {
        let thing = if text[item.clone()].starts_with('-') { "list item" } else { "key" };
        problem = problem.label(place.span(item), format!("a new {thing} starts here, still inside the bracket"));
    }
    let close = closing(bracket);
    problem.help(match last_word(inside) {
        Some(word) => format!("add `{close}` after `{word}`"),
        None => format!("add `{close}` after it"),
    })
}

fn never_opened(at: usize, text: &str, place: &Place<'_>) -> Diagnostic {
    let bracket = &text[at..at + 1];
    RULE.at(format!("this `{bracket}` closes nothing"), place.span(at..at + 1), "no bracket is open here")
        .help("remove it, or add the opening bracket")
}

fn mismatched(open: usize, at: usize, text: &str, place: &Place<'_>) -> Diagnostic {
    let (bracket, found) = (&text[open..open + 1], &text[at..at + 1]);
    let close = closing(bracket);
    RULE.at(format!("this `{found}` does not close `{bracket}`"), place.span(at..at + 1), "")
        .label(place.span(open..open + 1), "opened here")
        .help(format!("write `{close}` instead"))
}

fn closing(open: &str) -> char {
    if open == "[" { ']' } else { '}' }
}

/// The start of the first later line that looks like a list item or a key, and is not indented deeper than the line
/// of the bracket.
fn next_item(open: usize, text: &str, place: &Place<'_>) -> Option<Range<usize>> {
    let indent_of = |line: &str| line.len() - line.trim_start().len();
    let indent = indent_of(&text[place.line_range(open)]);
    let mut start = place.line_range(open).end;
    for line in text[start..].split_inclusive('\n') {
        let content = line.trim();
        let is_item = content.starts_with("- ") || content.split(' ').next().is_some_and(|word| word.ends_with(':'));
        if is_item && indent_of(line) <= indent && start > open && !line.trim_end().is_empty() {
            let from = start + indent_of(line);
            let length = content.find([',', ':']).unwrap_or(content.len());
            return Some(from..from + length);
        }
        start += line.len();
    }
    None
}

fn last_word(inside: &str) -> Option<&str> {
    let line = inside.lines().rev().map(|line| line.split(" #").next().unwrap_or(line)).find(|line| {
        let line = line.trim();
        !line.is_empty() && !line.starts_with('#')
    })?;
    line.split([' ', ',', '[', ']', '{', '}']).rfind(|word| !word.is_empty())
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
            error: [SCL0102] this `[` is never closed
             --> topology.yaml:2:5
              |
            2 |   - [sensor.measurements, controller.sensor
              |     ^ opened here
            3 |   - [controller.actuator, actuator.setpoint]
              |   ---------------------- a new list item starts here, still inside the bracket
              |
              = help: add `]` after `controller.sensor`"#]],
        );
    }
}
