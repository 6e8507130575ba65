//! SCL0123: no colon after a key.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::SourceFile;
use std::ops::Range;

/// SCL0123.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0123",
    severity: Severity::Error,
    title: "missing `:` after a key",
    explanation: "A key and its value are separated by a colon and a space. Here the colon is missing, or another mark \
                  stands in its place. Write the colon.",
    example: "-components
+components:
   - name: sensor
     gates: []
",
};

/// No colon after a word.
pub(in crate::parse) fn after(word: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let key = &text[word.clone()];
    RULE.at(format!("missing `:` after `{key}`"), source.span(word.clone()), "a key").help(format!("write `{key}:`"))
}

/// Another mark in the place of a colon.
pub(in crate::parse) fn instead(mark: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let found = &text[mark.clone()];
    let line = source.line_range(mark.start);
    let key = text[line.start..mark.start].trim_end().rsplit([' ', ',', '{']).next().unwrap_or("");
    let value = text[mark.end..line.end].trim_start().split([',', '}']).next().unwrap_or("").trim_end();
    RULE.at(format!("`{found}` stands where a colon is expected"), source.span(mark.clone()), "expected `:`")
        .help(format!("write `{key}: {value}`"))
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
            error: [SCL0123] missing `:` after `components`
             --> topology.yaml:1:1
              |
            1 | components
              | ^^^^^^^^^^ a key
              |
              = help: write `components:`"#]],
        );
    }
}
