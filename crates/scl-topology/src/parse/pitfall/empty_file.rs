//! SCL0115: nothing in the file.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::parse::dialect::Dialect;
use crate::source::SourceFile;
use crate::yaml::Tree;

/// SCL0115.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0115",
    severity: Severity::Error,
    title: "empty file",
    explanation: "The file is empty or contains only comments. Write at least the section `components`.",
    example: "-# TODO
+components:
+  - name: sensor
+    gates:
+      - measurements: pub
+connections: []
",
};

pub(super) fn find(tree: &Tree, source: &SourceFile, dialect: &Dialect) -> Option<Diagnostic> {
    if tree.root.as_ref().is_some_and(|root| !root.is_null()) {
        return None;
    }
    let text = source.text();
    let first = text.len() - text.trim_start().len();
    let line = source.line_range(first);
    let label = match text[first..].chars().next() {
        None => "nothing here",
        Some('#') => "only comments here",
        Some(_) => "no value here",
    };
    let span = if first == text.len() { source.span(0..0) } else { source.span(first..line.end.max(first)) };
    let Dialect { noun, minimal, .. } = dialect;
    Some(RULE.at(format!("the {noun} is empty"), span, label).help(format!("a minimal {noun}:\n{minimal}")))
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
            error: [SCL0115] the topology is empty
             --> topology.yaml:1:1
              |
            1 | # TODO
              | ^^^^^^ only comments here
              |
              = help: a minimal topology:
                      components:
                        - name: sensor
                          gates:
                            - measurements: pub"#]],
        );
    }
}
