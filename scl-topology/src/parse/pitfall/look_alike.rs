//! SCL0127: a character that looks like a mark of YAML and is another.

use super::Place;
use crate::diagnostic::Diagnostic;
use crate::rule::{Examples, Rule, Severity};
use crate::source::Span;
use std::ops::Range;

/// SCL0127.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0127",
    severity: Severity::Error,
    title: "character that looks like a mark of YAML",
    explanation: "Word processors and some keyboards write other colons, commas, quotes and dashes than YAML knows: \
                  fullwidth marks, curly quotes, long dashes. YAML reads them as letters. Retype the character.",
    examples: Examples::Topology {
        bad: "components:
  – name: sensor
    gates: []
",
        good: "components:
  - name: sensor
    gates: []
",
    },
};

/// What each character is called, and the mark it is taken for.
const MARKS: [(char, &str, &str); 34] = [
    ('：', "a fullwidth colon", ":"),
    ('，', "a fullwidth comma", ","),
    ('、', "an ideographic comma", ","),
    ('؛', "an Arabic semicolon", ","),
    ('；', "a fullwidth semicolon", ","),
    ('．', "a fullwidth full stop", "."),
    ('。', "an ideographic full stop", "."),
    ('·', "a middle dot", "."),
    ('［', "a fullwidth bracket", "["),
    ('］', "a fullwidth bracket", "]"),
    ('【', "a black bracket", "["),
    ('】', "a black bracket", "]"),
    ('｛', "a fullwidth brace", "{"),
    ('｝', "a fullwidth brace", "}"),
    ('＃', "a fullwidth number sign", "#"),
    ('＿', "a fullwidth low line", "_"),
    ('“', "a curly quote", "\""),
    ('”', "a curly quote", "\""),
    ('„', "a low quote", "\""),
    ('«', "an angle quote", "\""),
    ('»', "an angle quote", "\""),
    ('‘', "a curly quote", "'"),
    ('’', "a curly quote", "'"),
    ('＂', "a fullwidth quote", "\""),
    ('‐', "a typographic hyphen", "-"),
    ('‑', "a non-breaking hyphen", "-"),
    ('–', "an en dash", "-"),
    ('—', "an em dash", "-"),
    ('−', "a minus sign", "-"),
    ('－', "a fullwidth hyphen", "-"),
    ('•', "a bullet", "-"),
    ('→', "an arrow", "->"),
    ('⇒', "a double arrow", "->"),
    ('꞉', "a letter colon", ":"),
];

/// The characters of a text that look like a mark: place, character, mark.
pub(in crate::parse) fn marks(text: &str) -> impl Iterator<Item = (usize, char, &'static str)> {
    text.char_indices().filter(|(_, letter)| !letter.is_ascii()).filter_map(|(at, letter)| {
        let (_, _, mark) = MARKS.iter().find(|(other, _, _)| *other == letter)?;
        Some((at, letter, *mark))
    })
}

/// A text with the marks that were meant.
pub(in crate::parse) fn retyped(text: &str) -> String {
    let mut out = String::new();
    for letter in text.chars() {
        match MARKS.iter().find(|(other, _, _)| *other == letter) {
            Some((_, _, mark)) => out.push_str(mark),
            None => out.push(letter),
        }
    }
    out
}

/// The character at a place.
pub(super) fn diagnose(mark: &Range<usize>, place: &Place<'_>) -> Diagnostic {
    at(place.source.text()[mark.clone()].chars().next().unwrap_or(' '), place.span(mark.clone()))
}

/// The first such character in a span of the file.
pub(crate) fn first_in(written: &str, span: Span) -> Option<Diagnostic> {
    let (offset, mark, _) = marks(written).next()?;
    let start = span.start + offset as u32;
    Some(at(mark, Span { start, end: start + mark.len_utf8() as u32, ..span }))
}

fn at(letter: char, span: Span) -> Diagnostic {
    let (_, name, mark) = MARKS.iter().copied().find(|(other, _, _)| *other == letter).unwrap_or((letter, "", ""));
    let message = format!("`{letter}` (U+{:04X}) is {name}, not `{mark}`", u32::from(letter));
    let help = match mark {
        "\"" | "'" => "remove the quotes, which names do not need, or retype them as `\"`".to_owned(),
        _ => format!("retype it as `{mark}`"),
    };
    RULE.at(message, span, format!("not `{mark}`")).help(help)
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
            error: [SCL0127] `–` (U+2013) is an en dash, not `-`
             --> topology.yaml:2:3
              |
            2 |   – name: sensor
              |   ^ not `-`
              |
              = help: retype it as `-`"#]],
        );
    }
}
