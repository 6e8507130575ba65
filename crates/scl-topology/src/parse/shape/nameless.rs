//! SCL0208: a component without a name.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::parse::field::{Fields, head};
use crate::parse::shape_word;
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, NodeKind};

/// SCL0208.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0208",
    severity: Severity::Error,
    title: "component without a name",
    explanation: "Connections and programs refer to a component by its name, so each component needs one. Add `name:`.",
    example: " components:
-  - gates:
+  - name: sensor
+    gates:
       - measurements: pub
",
};

const MESSAGE: &str = "this component has no name";

pub(in crate::parse) fn diagnose(item: &Node, fields: &Fields<'_>, source: &SourceFile) -> Diagnostic {
    RULE.at(MESSAGE, head(item, fields, source), "`name` is missing").help("add `name: ...`")
}

/// Keys of a component with no `- name:` above them.
pub(in crate::parse) fn above(key: Span) -> Diagnostic {
    RULE.at(MESSAGE, key, "`- name: ...` is missing above this").help("start the component with `- name: ...`")
}

/// `- sensor` or a list in the place of a component.
pub(in crate::parse) fn not_a_mapping(item: &Node) -> Diagnostic {
    let label = format!("{}, where the keys of a component are expected", shape_word(item));
    let problem = RULE.at(MESSAGE, item.span, label);
    match &item.kind {
        NodeKind::Scalar { text, .. } => problem.help(format!("write `- name: {}`", text.trim())),
        _ => problem.help("write `- name: sensor` and below it `gates:`"),
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
                error: [SCL0208] this component has no name
                 --> topology.yaml:2:3
                  |
                2 |   - gates:
                  |   ^^^^^^^ `name` is missing
                  |
                  = help: add `name: ...`"#]],
        );
    }
}
