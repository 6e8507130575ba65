//! SCL0102: brackets that do not match.

use super::scan;
use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::SourceFile;
use crate::yaml::SyntaxError;
use std::ops::Range;

/// SCL0102.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0102",
    severity: Severity::Error,
    title: "bracket never closed",
    explanation: "A bracket or brace has no partner, or a partner of the wrong kind. The message points to the bracket \
                  itself, not to the later place where a parser notices it. Add or correct its partner.",
    example: "-connections:
-  - [sensor.measurements, controller.sensor
-  - [controller.actuator, actuator.setpoint]
+components: []
+connections: []
",
};

/// A bracket problem that the parser noticed as such.
pub(in crate::parse) fn find(error: &SyntaxError, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    match text.as_bytes().get(error.at) {
        Some(b'[' | b'{') => unbalanced(error.at, text, source),
        Some(b']' | b'}') if scan::scan(&text[..error.at]).open_brackets.is_empty() => {
            Some(never_opened(error.at, text, source))
        }
        _ => find_open(error, text, source),
    }
}

/// A bracket that is open where the parser stops.
pub(in crate::parse) fn find_open(error: &SyntaxError, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    let open = scan::scan(text.get(..error.at)?).open_brackets.pop()?;
    match text.as_bytes().get(error.at) {
        Some(b']' | b'}') => Some(mismatched(open, error.at, text, source)),
        _ => unbalanced(open, text, source),
    }
}

/// What is wrong with a bracket in its line: closed by one of the other kind, or not at all; nothing if it is closed.
fn unbalanced(open: usize, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    let mut still_open = Vec::new();
    for (at, letter) in text[open..source.line_range(open).end].bytes().enumerate() {
        match letter {
            b'[' | b'{' => still_open.push(open + at),
            b']' | b'}' => {
                let last = still_open.pop()?;
                if closing(&text[last..last + 1]) != char::from(letter) {
                    return Some(mismatched(last, open + at, text, source));
                }
            }
            _ => {}
        }
        if still_open.is_empty() {
            return None;
        }
    }
    Some(never_closed(open, text, source))
}

pub(in crate::parse) fn never_closed(open: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let bracket = &text[open..open + 1];
    let next = next_item(open, text, source);
    let inside = &text[open + 1..next.as_ref().map_or(text.len(), |item| item.start)];
    let mut problem = RULE.at(format!("this `{bracket}` is never closed"), source.span(open..open + 1), "opened here");
    if let Some(item) = next {
        let thing = if text[item.clone()].starts_with('-') { "list item" } else { "key" };
        problem = problem.label(source.span(item), format!("a new {thing} starts here, still inside the bracket"));
    }
    let close = closing(bracket);
    problem.help(match last_word(inside) {
        Some(word) => format!("add `{close}` after `{word}`"),
        None => format!("add `{close}` after it"),
    })
}

pub(in crate::parse) fn never_opened(at: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let bracket = &text[at..at + 1];
    RULE.at(format!("this `{bracket}` closes nothing"), source.span(at..at + 1), "no bracket is open here")
        .help("remove it, or add the opening bracket")
}

pub(in crate::parse) fn mismatched(open: usize, at: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let (bracket, found) = (&text[open..open + 1], &text[at..at + 1]);
    let close = closing(bracket);
    RULE.at(format!("this `{found}` does not close `{bracket}`"), source.span(at..at + 1), "")
        .label(source.span(open..open + 1), "opened here")
        .help(format!("write `{close}` instead"))
}

/// A bracket that should be closed after a word.
pub(in crate::parse) fn close_after(open: usize, word: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let bracket = &text[open..open + 1];
    let close = closing(bracket);
    let mut problem = never_closed(open, text, source);
    if source.line(open) != source.line(word.start) {
        problem.secondary.clear();
        problem = problem.label(source.span(word.clone()), format!("expected `{close}` after this"));
    }
    if !word.is_empty() {
        problem.helps.clear();
        problem = problem.help(format!("add `{close}` after `{}`", &text[word.clone()]));
    }
    problem
}

/// A bracket that should be opened before a word.
pub(in crate::parse) fn open_before(close: usize, word: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let found = &text[close..close + 1];
    let open = if found == "]" { '[' } else { '{' };
    RULE.at(format!("this `{found}` closes nothing"), source.span(close..close + 1), "no bracket is open here")
        .help(format!("add `{open}` before `{}`", &text[word.clone()]))
}

/// A list that is closed but never opened, after the colon of its key.
pub(in crate::parse) fn open_after(colon: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let line = source.line_range(colon.start);
    let key = text[line.start..colon.start].trim_start_matches([' ', '{', ',']).trim_end();
    let start = colon.start - text[line.start..colon.start].trim_end().len().min(key.len());
    RULE.at(format!("the list of {key} is never opened"), source.span(start..colon.end), "no bracket after this")
        .help("add `[` after the colon")
}

fn closing(open: &str) -> char {
    if open == "[" { ']' } else { '}' }
}

/// The start of the first later line that looks like a list item or a key, and is not indented deeper than the line
/// of the bracket.
fn next_item(open: usize, text: &str, source: &SourceFile) -> Option<Range<usize>> {
    let indent_of = |line: &str| line.len() - line.trim_start().len();
    let indent = indent_of(&text[source.line_range(open)]);
    let mut start = source.line_range(open).end;
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
    let code = line.trim_end();
    match code.ends_with([']', '}']) {
        true => code.get(code.len() - 1..),
        false => code.split([' ', ',', '[', ']', '{', '}']).rfind(|word| !word.is_empty()),
    }
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
