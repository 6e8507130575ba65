//! SCL0114: more than one document.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::{SourceFile, Span};

/// SCL0114.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0114",
    severity: Severity::Error,
    title: "more than one document",
    explanation: "`---` starts another YAML document in the same file. A topology is one document; most tools would \
                  silently ignore the rest. Remove the line.",
    example: " components: []
----
 connections: []
",
};

/// The parser may place the start of a document without `---` at its content.
pub(super) fn diagnose(source: &SourceFile, at: Span) -> Diagnostic {
    let rest = source.text().get(at.start as usize..).unwrap_or("");
    let marker = rest.starts_with("---");
    let help = if marker { "remove the `---` line" } else { "remove the `...` line above" };
    let span = if marker { Span { end: at.start + 3, ..at } } else { at };
    RULE.at("a topology is one YAML document; a second one starts here", span, "second document").help(help)
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
            error: [SCL0114] a topology is one YAML document; a second one starts here
             --> topology.yaml:2:1
              |
            2 | ---
              | ^^^ second document
              |
              = help: remove the `---` line"#]],
        );
    }
}
