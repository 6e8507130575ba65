//! SCL0314, a lint: a name in another style than the rest of the world of Rust writes fields and modules.

use super::named::{Noun, is_well_formed, names};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Model;
use crate::rust_name::gate_field;

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for (noun, name) in names(model).filter(|(noun, name)| *noun != Noun::System && is_well_formed(&name.value)) {
        let snake = gate_field(&name.value);
        if snake != name.value {
            let headline = format!("{} name `{}` is not snake_case", noun.word(), name.value);
            problems.push(Diagnostic::lint("SCL0314", headline, name.span, "").help(format!("write `{snake}`")));
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::example;
    use expect_test::expect;

    #[test]
    fn name_is_not_snake_case() {
        let yaml = r#"
components:
  - name: UserInterface
"#;
        example(
            "SCL0314",
            yaml.trim_start(),
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
