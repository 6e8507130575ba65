//! SCL0104: a quote is never closed.

use super::scan;
use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::SourceFile;
use crate::yaml::{SyntaxError, SyntaxErrorKind};

/// SCL0104.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0104",
    severity: Severity::Error,
    title: "quote never closed",
    explanation: "A quoted text is never closed, so YAML reads everything that follows as part of it. Add the closing \
                  quote, or remove the opening one: names need no quotes.",
    example: " components:
-  - name: \"sensor
+  - name: \"sensor\"
     gates: []
",
};

/// A quoted text that runs over the end of its line and covers, or ends just before, the place of the error.
pub(in crate::parse) fn find(error: &SyntaxError, text: &str, source: &SourceFile) -> Option<Diagnostic> {
    let quoted = scan::scan(text).quoted;
    let next = quoted.partition_point(|range| range.start <= error.at);
    let range = quoted.get(next.checked_sub(1)?)?.clone();
    let reaches = range.end >= error.at || error.kind == SyntaxErrorKind::Quote && range.end + 1 >= error.at;
    let several_lines = text.get(range.clone())?.contains('\n') || range.end == text.len();
    if !(reaches && several_lines) {
        return None;
    }
    let quote = &text[range.start..range.start + 1];
    let help = format!("add the closing `{quote}` at the end of line {}", source.line(range.start));
    let span = source.span(range.start..range.start + 1);
    Some(RULE.at("this quoted string is never closed", span, "opened here").help(help))
}

/// A quote without a partner in its line.
pub(in crate::parse) fn alone(at: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let quote = &text[at..at + 1];
    RULE.at("this quote has no partner", source.span(at..at + 1), "the only one in its line")
        .help(format!("remove it, or add the other `{quote}`"))
}

/// The place of a quote that is missing before or after a word.
pub(in crate::parse) fn missing(at: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let is_word = |letter: char| letter.is_alphanumeric() || matches!(letter, '_' | '.' | '-');
    let after = text[at..].len() - text[at..].trim_start_matches(is_word).len();
    let before = text[..at].len() - text[..at].trim_end_matches(is_word).len();
    let side = if after > 0 { "before" } else { "after" };
    let word = at - before..at + after;
    let name = &text[word.clone()];
    RULE.at(format!("a quote is missing {side} `{name}`"), source.span(word), "has a quote at one end only")
        .help(format!("write `\"{name}\"`"))
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
            error: [SCL0104] this quoted string is never closed
             --> topology.yaml:2:11
              |
            2 |   - name: "sensor
              |           ^ opened here
              |
              = help: add the closing `"` at the end of line 2"#]],
        );
    }
}
