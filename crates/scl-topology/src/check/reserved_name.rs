//! SCL0311: names that the framework keeps for itself, so that it can grow without breaking a file.

use super::named::{Noun, names};
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::model::Model;

/// SCL0311.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0311",
    severity: Severity::Error,
    title: "reserved name",
    explanation: "The framework keeps a few names for itself, so that it can grow without breaking files: `scl`, \
                  `topology`, and names that start with `scl_` or `__`. Choose another.",
    example: " components:
-  - name: scl
+  - name: framework
+    gates: []
",
};

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for (noun, name) in names(model) {
        if is_reserved(noun, &name.value) {
            let headline = format!("`{}` is reserved for the framework", name.value);
            let found = RULE
                .at(headline, name.span, "")
                .help("choose another name")
                .note("reserved: `scl`, `topology`, and names that start with `scl_` or `__`");
            problems.push(found);
        }
    }
}

fn is_reserved(noun: Noun, name: &str) -> bool {
    match noun {
        // A folder may have any name, and `topology` is the usual one.
        Noun::System => false,
        Noun::Component => name == "scl" || name == "topology" || name.starts_with("scl_") || name.starts_with("__"),
        Noun::Gate => name.starts_with("__"),
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn reserved_name() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0311] `scl` is reserved for the framework
             --> topology.yaml:2:11
              |
            2 |   - name: scl
              |           ^^^
              |
              = help: choose another name
              = note: reserved: `scl`, `topology`, and names that start with `scl_` or `__`
        "#]],
        );
    }
}
