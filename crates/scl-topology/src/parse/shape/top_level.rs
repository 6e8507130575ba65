//! SCL0201: the top level is not a mapping.

use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::parse::dialect::Dialect;
use crate::parse::{pitfall, with_dash};
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, NodeKind};

/// SCL0201.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0201",
    severity: Severity::Error,
    title: "top level is not a mapping",
    explanation: "A topology is a mapping: section names with their values. This file starts with something else, \
                  often with the list that belongs below `components:`. Add the key and indent the list.",
    example: "-- name: sensor
-  gates:
-    - measurements: pub
+components:
+  - name: sensor
+    gates:
+      - measurements: pub
+connections: []
",
};

pub(in crate::parse) fn diagnose(root: &Node, source: &SourceFile, dialect: &Dialect) -> Diagnostic {
    if let Some(problem) = pitfall::missing_space::in_node(root, source, dialect) {
        return problem;
    }
    let start = with_dash(root.span, source);
    let end = (source.line_range(start.start as usize).end as u32).min(start.end.max(start.start));
    let span = Span { end, ..start };
    let is_list = matches!(root.kind, NodeKind::Sequence { .. });
    let (thing, label) = if is_list { ("a list", "list item") } else { ("text", "text without a key") };
    let message = format!("a topology starts with `components:`, and this file starts with {thing}");
    let problem = RULE.at(message, span, label);
    const FORM: &str =
        "a topology has `components:`, and below it a list of components, each with a `name` and `gates`";
    match &root.kind {
        NodeKind::Sequence { .. } => {
            let line = source.line_range(start.start as usize).start as u32;
            let above = Edit::new(Span { start: line, end: line, ..start }, "components:\n");
            problem.propose("write `components:` above this list", [above]).otherwise(FORM)
        }
        _ => problem.help(FORM),
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
                error: [SCL0201] a topology starts with `components:`, and this file starts with a list
                 --> topology.yaml:1:1
                  |
                1 | - name: sensor
                  | ^^^^^^^^^^^^^^ list item
                  |
                  = help: write `components:` above this list"#]],
        );
    }
}
