//! SCL0122: no comma between two entries in brackets.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::SourceFile;
use std::ops::Range;

/// SCL0122.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0122",
    severity: Severity::Error,
    title: "missing comma",
    explanation: "In brackets and braces a comma separates the entries. Without it, or with another mark in its place, \
                  YAML reads two entries as one. Write the comma.",
    example: " components:
   - name: controller
     gates:
-      - sensor: {sub: Measurement queue: 4}
+      - sensor: {sub: Measurement, queue: 4, unconnected: ok}
",
};

/// No comma between two words.
pub(in crate::parse) fn between(
    before: &Range<usize>,
    after: &Range<usize>,
    text: &str,
    source: &SourceFile,
) -> Diagnostic {
    let (first, second) = (&text[before.clone()], &text[after.clone()]);
    let message = format!("a comma is missing before {}", described(second));
    let help = match first {
        ":" => format!("add `,` before `{second}`"),
        _ => format!("add `,` after `{first}`"),
    };
    match source.line(before.start) == source.line(after.start) {
        true => RULE.at(message, source.span(after.clone()), "a new entry starts here").help(help),
        false => RULE
            .at(message, source.span(before.clone()), "no comma after this")
            .label(source.span(after.clone()), "a new entry starts here")
            .help(help),
    }
}

/// Another mark in the place of a comma.
pub(in crate::parse) fn instead(mark: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let message = format!("`{}` does not separate entries", &text[mark.clone()]);
    RULE.at(message, source.span(mark.clone()), "expected a comma").help("write `,`")
}

fn described(word: &str) -> String {
    match word {
        "{" | "[" => format!("this `{word}`"),
        _ => format!("`{word}`"),
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
            error: [SCL0122] a comma is missing before `queue`
             --> topology.yaml:4:35
              |
            4 |       - sensor: {sub: Measurement queue: 4}
              |                                   ^^^^^ a new entry starts here
              |
              = help: add `,` after `Measurement`"#]],
        );
    }
}
