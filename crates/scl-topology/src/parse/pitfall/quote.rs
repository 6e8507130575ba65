//! SCL0104: a quote is never closed.

use super::scan;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
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
    let span = source.span(range.start..range.start + 1);
    let problem = RULE.at("this quoted string is never closed", span, "opened here");
    let line = source.line_range(range.start);
    let rest = text[range.start..line.end].trim_end();
    let at_end = format!("add the closing `{quote}` at the end of line {}", source.line(range.start));
    let close = |length: usize| {
        let end = range.start + length;
        [Edit::new(source.span(end..end), quote)]
    };
    let problem = match ends_in_brackets(rest, &text[line.start..range.start]) {
        Some(ends) => ends.iter().fold(problem, |problem, end| {
            let word = rest[..*end].split(' ').next_back().unwrap_or(rest);
            problem.suggest(format!("add the closing `{quote}` after `{word}`"), close(*end))
        }),
        None => problem.suggest(&*at_end, close(rest.len())),
    };
    Some(problem.otherwise(at_end))
}

/// Maximum number of places in brackets where a quoted text may end.
const MOST_ENDS: usize = 3;

/// Where a quoted text in brackets may end: before a comma with a space, or before a closing bracket. `None` outside of
/// brackets.
fn ends_in_brackets(rest: &str, before: &str) -> Option<Vec<usize>> {
    if before.matches(['[', '{']).count() <= before.matches([']', '}']).count() {
        return None;
    }
    let commas = rest
        .match_indices(", ")
        .filter(|(at, _)| rest[at + 2..].split(' ').next().is_some_and(|word| word.ends_with(':')));
    let brackets = rest.match_indices([']', '}']).take(1);
    let mut ends: Vec<usize> = commas.map(|(at, _)| at).take(1).chain(brackets.map(|(at, _)| at)).collect();
    ends.extend(rest.match_indices(", ").map(|(at, _)| at));
    ends.retain(|end| *end > 1);
    let mut seen = Vec::new();
    ends.retain(|end| {
        !seen.contains(end) && {
            seen.push(*end);
            true
        }
    });
    ends.truncate(MOST_ENDS);
    Some(ends)
}

/// A quote without a partner in its line.
pub(in crate::parse) fn alone(at: usize, text: &str, source: &SourceFile) -> Diagnostic {
    let problem = RULE.at("this quote has no partner", source.span(at..at + 1), "the only one in its line");
    problem.help(format!("remove this `{}`", &text[at..at + 1]))
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
