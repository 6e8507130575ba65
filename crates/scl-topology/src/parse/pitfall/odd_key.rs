//! SCL0120: a key that is no plain word.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::yaml::Node;

/// SCL0120.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0120",
    severity: Severity::Error,
    title: "key is not a plain word",
    explanation: "YAML allows lists and mappings as keys, and null. In a topology each key is a plain word. Write one.",
    example: " components:
-  - ? [a, b]
-    : pub
+  - name: sensor
+    gates:
+      - measurements: pub
+connections: []
",
};

pub(in crate::parse) fn diagnose(key: &Node) -> Diagnostic {
    let label = format!("this key is {}", crate::parse::shape_word(key));
    RULE.at("a key must be a plain word", key.span, label)
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
            error: [SCL0120] a key must be a plain word
             --> topology.yaml:2:7
              |
            2 |   - ? [a, b]
              |       ^^^^^^ this key is a list"#]],
        );
    }
}
