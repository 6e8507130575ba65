//! SCL0124: a list item without its dash, or with an odd one.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::SourceFile;
use std::ops::Range;

/// SCL0124.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0124",
    severity: Severity::Error,
    title: "list item without a proper dash",
    explanation: "Each item of a list starts with one dash and a space. Here the dash or the space is missing, or \
                  there is a dash too many. Write `- ` before the item.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: pub
-      -status: pub
+      - measurements: {pub: , unconnected: ok}
+      - status: {pub: , unconnected: ok}
",
};

/// Maximum length of a line that a help repeats, in characters.
const MOST_SHOWN: usize = 60;

/// An item, from its first character to the end of its line, without a dash.
pub(in crate::parse) fn missing(item: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let content = &text[item.clone()];
    let word = content.split([' ', ':', ',']).next().filter(|word| !word.is_empty()).unwrap_or(content);
    let span = source.span(item.start..item.start + word.len());
    RULE.at("missing `-` before this list item", span, "starts no list item").help(write_item(content))
}

/// A dash that is glued to its item.
pub(in crate::parse) fn without_space(dash: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let rest = text[dash.end..source.line_range(dash.start).end].trim();
    RULE.at("missing space after `-`", source.span(dash.clone()), "starts no list item").help(write_item(rest))
}

/// Two dashes.
pub(in crate::parse) fn doubled(dashes: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let rest = text[dashes.end..source.line_range(dashes.start).end].trim();
    let message = "a list item starts with one `-`, not with two";
    RULE.at(message, source.span(dashes.clone()), "starts no list item").help(write_item(rest))
}

/// `* item`.
pub(in crate::parse) fn other_mark(at: usize, source: &SourceFile) -> Diagnostic {
    let text = source.text();
    let (mark, rest) = (&text[at..at + 1], text[at + 1..source.line_range(at).end].trim());
    let message = format!("a list item starts with `-`, not with `{mark}`");
    RULE.at(message, source.span(at..at + 1), "expected `-`").help(write_item(rest))
}

/// A dash where no item can start.
pub(in crate::parse) fn surplus(dash: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let line = source.line_range(dash.start);
    let is_doubled =
        text[line.start..dash.start].trim_start().starts_with('-') || text[dash.end..line.end].starts_with('-');
    let message = match is_doubled {
        true => "a list item starts with one `-`, not with two",
        false => "no list item can start here",
    };
    RULE.at(message, source.span(dash.clone()), "one dash too many").help("remove this `-`")
}

fn write_item(content: &str) -> String {
    match content.chars().count() > MOST_SHOWN {
        true => "write `- ` before it".to_owned(),
        false => format!("write `- {content}`"),
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
            error: [SCL0124] missing space after `-`
             --> topology.yaml:5:7
              |
            5 |       -status: pub
              |       ^ starts no list item
              |
              = help: write `- status: pub`"#]],
        );
    }
}
