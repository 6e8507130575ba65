//! SCL0102: brackets that do not match.

use super::scan;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
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
            let removed = vec![Edit::new(source.span(error.at..error.at + 1), "")];
            Some(never_opened(error.at, text, source).carry(removed, false))
        }
        _ => find_open(error, text, source),
    }
}

/// A bracket that is open where the parser stops.
pub(in crate::parse) fn find_open(error: &SyntaxError, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    let open = scan::scan(text.get(..error.at)?).open_brackets.pop()?;
    match text.as_bytes().get(error.at) {
        Some(b']' | b'}') => Some(with_partner(open, error.at, text, source)),
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
                    return Some(with_partner(last, open + at, text, source));
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

/// A bracket that is never closed, with the place after the last word before the next item.
fn never_closed(open: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let problem = open_ended(open, text, source);
    let end = next_item(open, text, source).map_or(text.len(), |item| source.line_range(item.start).start);
    let close = closing(&text[open..open + 1]);
    let Some(word) = last_word(open + 1..end, text) else {
        let after = source.span(open + 1..open + 1);
        return problem.suggest(format!("add `{close}` after it"), [Edit::new(after, close)]);
    };
    let edits = [Edit::new(source.span(word.end..word.end), close)];
    problem
        .suggest(format!("add `{close}` after `{}`", &text[word]), edits)
        .otherwise(format!("more than `{close}` is missing here: the end of the line, or of the lines below"))
}

/// The problem of a bracket that is never closed.
fn open_ended(open: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let bracket = &text[open..open + 1];
    let problem = RULE.at(format!("this `{bracket}` is never closed"), source.span(open..open + 1), "opened here");
    let Some(item) = next_item(open, text, source) else { return problem };
    let thing = if text[item.clone()].starts_with('-') { "list item" } else { "key" };
    problem.label(source.span(item), format!("a new {thing} starts here, still inside the bracket"))
}

/// A bracket without which the text is sound.
pub(in crate::parse) fn surplus(open: usize, text: &str, source: &SourceFile) -> Diagnostic {
    open_ended(open, text, source).help(format!("remove this `{}`", &text[open..open + 1]))
}

pub(in crate::parse) fn never_opened(at: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let bracket = &text[at..at + 1];
    RULE.at(format!("this `{bracket}` closes nothing"), source.span(at..at + 1), "no bracket is open here")
        .help(format!("remove this `{bracket}`"))
}

/// As [`mismatched`], with the closing bracket that fits.
fn with_partner(open: usize, at: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let close = closing(&text[open..open + 1]);
    mismatched(open, at, at, text, source).carry(vec![Edit::new(source.span(at..at + 1), close)], false)
}

/// Two brackets of different kinds, of which the one `at` a place is wrong.
pub(in crate::parse) fn mismatched(
    open: usize,
    close: usize,
    at: usize,
    text: &str,
    source: &SourceFile,
) -> Diagnostic {
    let (bracket, found) = (&text[open..open + 1], &text[close..close + 1]);
    let meant = if at == open { opening(found) } else { closing(bracket) };
    RULE.at(format!("this `{found}` does not close `{bracket}`"), source.span(close..close + 1), "")
        .label(source.span(open..open + 1), "opened here")
        .help(format!("write `{meant}` in place of `{}`", &text[at..at + 1]))
}

/// A bracket that should be closed after a word.
/// The mark `replaced`, which may be nothing, gives way to the closing bracket.
pub(in crate::parse) fn close_after(
    open: usize,
    word: &Range<usize>,
    replaced: &str,
    text: &str,
    source: &SourceFile,
) -> Diagnostic {
    let bracket = &text[open..open + 1];
    let close = closing(bracket);
    let mut problem = open_ended(open, text, source);
    if source.line(open) != source.line(word.start) {
        problem.secondary.clear();
        problem = problem.label(source.span(word.clone()), format!("expected `{close}` after this"));
    }
    match word.is_empty() {
        _ if !replaced.is_empty() => problem.help(format!("write `{close}` in place of the last `{replaced}`")),
        true => problem.help(format!("add `{close}`")),
        false => problem.help(format!("add `{close}` after `{}`", &text[word.clone()])),
    }
}

/// `(` and `)` in place of two `brackets`.
pub(in crate::parse) fn parentheses(open: &Range<usize>, brackets: &[&str], source: &SourceFile) -> Diagnostic {
    let (left, right) = (brackets.first().unwrap_or(&"{"), brackets.last().unwrap_or(&"}"));
    let what = if *left == "{" { "keys" } else { "a list" };
    RULE.at(
        "parentheses have no meaning in YAML",
        source.span(open.clone()),
        format!("{what} in `{left}` and `{right}`"),
    )
    .help(format!("write `{left}` and `{right}` in place of the parentheses"))
}

/// `x: pub: A`, where the value needs braces.
pub(in crate::parse) fn braces(value: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let line = source.line_range(value.start);
    let key = text[line.start..value.start].trim_start();
    RULE.at("a second key and its value in one line need braces", source.span(value.clone()), "no braces around this")
        .help(format!("write `{key}{{{}}}`", &text[value.clone()]))
}

/// A bracket that should be opened before a word.
pub(in crate::parse) fn open_before(close: usize, word: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let found = &text[close..close + 1];
    let open = opening(found);
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

fn opening(close: &str) -> char {
    if close == "]" { '[' } else { '{' }
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

/// The last word of a part of the text, without comments.
fn last_word(part: Range<usize>, text: &str) -> Option<Range<usize>> {
    let mut end = part.end;
    loop {
        let start = text[part.start..end].rfind('\n').map_or(part.start, |at| part.start + at + 1);
        let line = &text[start..end];
        let code = if line.trim_start().starts_with('#') { "" } else { line.split(" #").next().unwrap_or(line) };
        let code = code.trim_end().trim_end_matches(',');
        if !code.is_empty() {
            let is_bracket = code.ends_with([']', '}']);
            let word =
                code.rfind([' ', ',', '[', ']', '{', '}']).filter(|at| at + 1 < code.len()).map_or(0, |at| at + 1);
            return Some(start + if is_bracket { code.len() - 1 } else { word }..start + code.len());
        }
        end = start.checked_sub(1).filter(|end| *end >= part.start)?;
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
