//! SCL0112: the merge key `<<`.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::yaml::Node;

/// SCL0112.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0112",
    severity: Severity::Error,
    title: "merge key",
    explanation: "`<<` merges keys of another mapping in some YAML tools; it is no part of YAML 1.2, so tools disagree \
                  about it. Write the keys out.",
    example: " components:
   - name: b
-    <<: {gates: []}
+    gates: []
",
};

pub(in crate::parse) fn diagnose(key: &Node) -> Diagnostic {
    let message = "the merge key `<<` is not supported";
    RULE.at(message, key.span, "YAML 1.1 extension, not part of YAML 1.2").help("write the keys out")
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
            error: [SCL0112] the merge key `<<` is not supported
             --> topology.yaml:3:5
              |
            3 |     <<: {gates: []}
              |     ^^ YAML 1.1 extension, not part of YAML 1.2
              |
              = help: write the keys out"#]],
        );
    }
}
