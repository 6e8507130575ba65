//! SCL0113: a YAML tag.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::Span;

/// SCL0113.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0113",
    severity: Severity::Error,
    title: "tag",
    explanation: "A tag such as `!!str` changes the type of a value, and in some languages even runs code. A topology \
                  needs none. Remove it.",
    example: " components:
-  - name: !!python/name:os.system sensor
+  - name: sensor
+    gates: []
",
};

pub(super) fn diagnose(tag: Span) -> Diagnostic {
    RULE.at("YAML tags are not supported in a topology", tag, "tag").help("remove the tag")
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
            error: [SCL0113] YAML tags are not supported in a topology
             --> topology.yaml:2:11
              |
            2 |   - name: !!python/name:os.system sensor
              |           ^^^^^^^^^^^^^^^^^^^^^^^ tag
              |
              = help: remove the tag"#]],
        );
    }
}
