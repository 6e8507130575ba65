//! SCL0314, a lint: a name in another style than the rest of the world of Rust writes fields and modules.

use super::named::{Noun, is_well_formed, names};
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::model::Model;
use crate::rust_name::gate_field;

/// SCL0314.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0314",
    severity: Severity::Lint,
    title: "name is not snake_case",
    explanation: "By convention names are snake_case, as the Rust fields and modules are that they become. Other \
                  styles work; the lint is for teams that want one style.",
    example: " components:
-  - name: UserInterface
+  - name: user_interface
+    gates: []
",
};

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for (noun, name) in names(model).filter(|(noun, name)| *noun != Noun::System && is_well_formed(&name.value)) {
        let snake = gate_field(&name.value);
        if snake != name.value {
            let headline = format!("{} name `{}` is not snake_case", noun.word(), name.value);
            problems.push(RULE.at(headline, name.span, "").help(format!("write `{snake}`")));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn name_is_not_snake_case() {
        rule_example(
            &RULE,
            expect![[r#"
            warning: [SCL0314] component name `UserInterface` is not snake_case
             --> topology.yaml:2:11
              |
            2 |   - name: UserInterface
              |           ^^^^^^^^^^^^^
              |
              = help: write `user_interface`
        "#]],
        );
    }
}
