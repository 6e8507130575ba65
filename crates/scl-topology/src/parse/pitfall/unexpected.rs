//! SCL0125: something behind a value, or between two, that belongs to neither.

use crate::diagnostic::{Diagnostic, MOST_LABELS, Rule, Severity};
use crate::source::SourceFile;
use std::ops::Range;

/// SCL0125.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0125",
    severity: Severity::Error,
    title: "unexpected text",
    explanation: "The line continues after its value has ended, or contains a character that cannot be there. A key \
                  has one value, and each list item has its own line. Remove the rest, or move it to a separate line.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: {pub: Measurement} often
+      - measurements: {pub: Measurement, unconnected: ok} # often
",
};

/// Maximum length of a text that a message repeats, in characters.
const MOST_SHOWN: usize = 40;

pub(in crate::parse) fn diagnose(range: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let word = &text[range.clone()];
    let line = source.line_range(range.start);
    let before = text[line.start..range.start].trim_end();
    let after = match before.chars().last() {
        Some(bracket @ (']' | '}')) => format!(" after `{bracket}`"),
        _ => String::new(),
    };
    let shown = match word.chars().count() > MOST_SHOWN {
        true => "this text".to_owned(),
        false => format!("`{word}`"),
    };
    let label = if after.is_empty() { "not expected" } else { "the value ends before it" };
    let problem = RULE.at(format!("{shown} is not expected here{after}"), source.span(range.clone()), label);
    let is_item = before.trim_start().starts_with('-');
    match word.chars().next() {
        Some('[' | '{') if is_item => problem.help("start each list item on a line of its own, with `-`"),
        Some('#') => problem.help("write a space before `#`"),
        _ if before.ends_with('}') && word.contains(": ") => {
            problem.help("write it inside the braces, after a comma, or remove it")
        }
        _ => problem.help("remove it"),
    }
}

/// `A[]`.
pub(in crate::parse) fn brackets_after_type(range: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let word = &text[range.clone()];
    let name = word.split(['[', '{']).next().unwrap_or(word);
    let others = text.match_indices(word).filter(|(at, _)| *at != range.start).take(MOST_LABELS);
    RULE.at(format!("`{word}` is not a type"), source.span(range.clone()), "brackets after a name")
        .labels(others.map(|(at, _)| (source.span(at..at + word.len()), "and here")))
        .help(format!("write `{name}`"))
        .help(
            "a gate carries messages: for a list, declare a message with a `repeated` field in a schema, or a type in \
             Rust, and write its name here",
        )
}

/// `{pub: Bus: A}` and `{rep: A: B}`: the value with its colon, and what replaces part of it.
pub(in crate::parse) fn second_colon(value: &Range<usize>, with: &str, text: &str, source: &SourceFile) -> Diagnostic {
    let written = &text[value.clone()];
    let (first, second) = written.split_once(':').unwrap_or((written, ""));
    let meant = match with.trim() {
        "" => second.trim_start().to_owned(),
        "->" => format!("{first} -> {}", second.trim_start()),
        mark => format!("{first}{mark}{}", second.trim_start()),
    };
    let line = source.line_range(value.start);
    let key = text[line.start..value.start].rsplit(['{', ',']).next().unwrap_or("").trim_start();
    let colon = value.start + first.len();
    RULE.at("a key has one value, and this is a second colon", source.span(colon..colon + 1), "not expected")
        .help(format!("write `{key}{meant}`"))
}

/// `}#c`.
pub(in crate::parse) fn glued_comment(hash: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let comment = text[hash..source.line_range(hash).end].trim_end();
    let label = "a comment, but for the space";
    RULE.at("a comment starts with a space and `#`", source.span(hash..hash + comment.len()), label)
        .help("write a space before `#`")
}

/// `system: a codec: b`.
pub(in crate::parse) fn key_in_line(rest: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let message = "each key stands on a line of its own";
    RULE.at(message, source.span(rest.clone()), "a second key in the line")
        .help(format!("move `{}` to the next line", &text[rest.clone()]))
}

/// `- x: pub - y: pub`.
pub(in crate::parse) fn item_in_line(dash: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let rest = text[dash..source.line_range(dash).end].trim_end();
    let label = "a second item in the line";
    RULE.at("each list item stands on a line of its own", source.span(dash..dash + rest.len()), label)
        .help(format!("move `{rest}` to the next line"))
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
            error: [SCL0125] `often` is not expected here after `}`
             --> topology.yaml:4:42
              |
            4 |       - measurements: {pub: Measurement} often
              |                                          ^^^^^ the value ends before it
              |
              = help: remove it"#]],
        );
    }
}
