//! SCL0205: the section `components` is empty.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::parse::field::Field;

/// SCL0205.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0205",
    severity: Severity::Error,
    title: "no components",
    explanation: "The section `components` has no entry. Add at least one component; a file that is meant to be empty \
                  says `components: []`.",
    example: "-components:
+components: []
 connections: []
",
};

/// An explicit `components: []` is meant, as it is for gates and connections.
pub(in crate::parse) fn diagnose(section: Field<'_>) -> Diagnostic {
    RULE.at("the topology has no components", section.key_span, "the section is empty")
        .help("add at least one component")
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
            error: [SCL0205] the topology has no components
             --> topology.yaml:1:1
              |
            1 | components:
              | ^^^^^^^^^^ the section is empty
              |
              = help: add at least one component"#]],
        );
    }
}
