//! SCL0103: no space after `:`.

use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::parse::dialect::Dialect;
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, SyntaxError};
use std::ops::Range;

/// SCL0103.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0103",
    severity: Severity::Error,
    title: "missing space after `:`",
    explanation: "A key and its value are separated by a colon and a space. Without the space, YAML reads both as one \
                  word. Add the space.",
    example: " components:
-  - name:sensor
+  - name: sensor
     gates: []
",
};

/// Number of lines that are searched for the mistake, from the line of the error upwards.
const LINES: usize = 3;

/// A word such as `name:sensor` where a mapping is expected.
pub(in crate::parse) fn in_node(node: &Node, source: &SourceFile, dialect: &Dialect) -> Option<Diagnostic> {
    if !node.is_plain() {
        return None;
    }
    let written = source.snippet(node.span);
    let (key, value) = split(written.lines().next()?)?;
    Some(diagnose(key, value, node.span, dialect))
}

/// A key of a mapping that starts a list or mapping at its colon: `gates:[x: pub]`.
pub(in crate::parse) fn in_key(key: &Node, text: &str, dialect: &Dialect) -> Option<Diagnostic> {
    let (word, value) = split(text).filter(|_| key.is_plain())?;
    value.starts_with(['[', '{']).then(|| diagnose(word, value, key.span, dialect))
}

/// `{x:{pub: A}}`: YAML 1.2 allows it, and most readers do not.
pub(in crate::parse) fn in_brackets(
    glued: &Range<usize>,
    text: &str,
    source: &SourceFile,
    dialect: &Dialect,
) -> Diagnostic {
    let written = &text[glued.clone()];
    let (key, value) = written.split_once(':').unwrap_or((written, ""));
    diagnose(key, value, source.span(glued.start..glued.start), dialect)
}

/// The colon at or shortly before an error, where a bracket follows at once.
pub(in crate::parse) fn at_bracket(
    error: &SyntaxError,
    text: &str,
    source: &SourceFile,
    dialect: &Dialect,
) -> Option<Diagnostic> {
    let end = text.get(error.at..)?.find(['[', '{'])?;
    let bracket = error.at + end;
    let before = text[..bracket].strip_suffix(':')?;
    let start = before.rfind([' ', ',', '[', '{', '\n']).map_or(0, |at| at + 1);
    Some(in_brackets(&(start..bracket + 1), text, source, dialect))
}

/// A word such as `name:sensor` in the lines before a syntax error.
pub(in crate::parse) fn before(error: &SyntaxError, source: &SourceFile, dialect: &Dialect) -> Option<Diagnostic> {
    let text = source.text();
    let mut line = source.line_range(error.at);
    for _ in 0..LINES {
        let content = &text[line.clone()];
        let word = content.trim_start_matches([' ', '-']);
        if let Some((key, value)) = split(word) {
            let start = line.start + content.len() - word.len();
            let problem = diagnose(key, value, source.span(start..start), dialect);
            return Some(with_words(problem, error, start, source));
        }
        line = source.line_range(line.start.checked_sub(1)?);
    }
    None
}

fn with_words(problem: Diagnostic, error: &SyntaxError, start: usize, source: &SourceFile) -> Diagnostic {
    let noticed = source.line(error.at);
    if noticed == source.line(start) {
        return problem;
    }
    problem.note(format!("the parser notices it only on line {noticed}, where it says \"{}\"", error.words))
}

/// The problem of a key and all that stands after its colon; the span starts with the key.
fn diagnose(key: &str, written_after: &str, at: Span, dialect: &Dialect) -> Diagnostic {
    let value = written_after.split_whitespace().next().unwrap_or("");
    let colon = at.start + key.len() as u32;
    let span = Span { start: colon, end: colon + 1, ..at };
    let problem = RULE.at("missing space after `:`", span, format!("YAML reads `{key}:{value}` as one word"));
    let help = match value.starts_with(['[', '{']) {
        true => format!("write a space after `{key}:`"),
        false => format!("write `{key}: {value}`"),
    };
    let space = [Edit::new(Span { start: span.end, ..span }, " ")];
    // If several words follow the colon, the colon itself may be the mistake, so the fix is not certain.
    let is_one = written_after.trim_end() == value || value.starts_with(['[', '{']);
    match is_one && ((dialect.word)(key).or_else(|| (dialect.word)(value)).is_some()) {
        true => problem.propose(help, space),
        false => problem.suggest(help, space),
    }
}

/// Key and rest of `name:sensor`; not of `my_crate::Codec`, nor of an address such as `tcp://host`.
fn split(word: &str) -> Option<(&str, &str)> {
    let (key, rest) = word.split_once(':')?;
    let value = rest.split_whitespace().next().filter(|_| !rest.starts_with(char::is_whitespace))?;
    let is_word = key.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && key.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-'));
    (is_word && !value.starts_with([':', '/', '\\'])).then_some((key, rest))
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
            error: [SCL0103] missing space after `:`
             --> topology.yaml:2:9
              |
            2 |   - name:sensor
              |         ^ YAML reads `name:sensor` as one word
              |
              = help: write `name: sensor`
              = note: the parser notices it only on line 3, where it says "mapping values are not allowed in this context""#]],
        );
    }
}
