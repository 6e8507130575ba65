//! Lints about names that work. SCL0313: a component whose type hides a name that every Rust file has in scope.
//! SCL0314: a name in another style than the fields and modules of Rust.

use super::named::{Noun, names, types};
use super::rename::Renames;
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::model::Model;
use crate::rust_name::{component_type, gate_field};

/// SCL0313.
pub(crate) const HIDES_PRELUDE: Rule = Rule {
    code: "SCL0313",
    severity: Severity::Lint,
    title: "type name hides a prelude type",
    explanation: "The component's Rust type has the same name as a type of Rust's prelude, such as `Result`. Importing \
                  it by name hides the prelude's type. Choose a name that says more, or import it under another name.",
    example: " components:
-  - name: result
+  - name: match_result
+    gates: []
",
};

/// Names that Rust imports by default, and where they come from.
const PRELUDE: [(&str, &str); 15] = [
    ("Result", "core::result::Result"),
    ("Option", "core::option::Option"),
    ("Some", "core::option::Option::Some"),
    ("None", "core::option::Option::None"),
    ("Ok", "core::result::Result::Ok"),
    ("Err", "core::result::Result::Err"),
    ("Box", "std::boxed::Box"),
    ("Vec", "std::vec::Vec"),
    ("String", "std::string::String"),
    ("Send", "core::marker::Send"),
    ("Sync", "core::marker::Sync"),
    ("Drop", "core::ops::Drop"),
    ("Clone", "core::clone::Clone"),
    ("Default", "core::default::Default"),
    ("Iterator", "core::iter::Iterator"),
];

pub(super) fn check<'m>(model: &'m Model, renames: &Renames<'m>, problems: &mut Diagnostics) {
    check_prelude(model, problems);
    check_snake_case(model, renames, problems);
}

fn check_prelude(model: &Model, problems: &mut Diagnostics) {
    for (noun, name) in types(model).filter(|(noun, name)| noun.is_well_formed(&name.value)) {
        let rust = component_type(&name.value);
        let Some((_, hidden)) = PRELUDE.iter().find(|(short, _)| *short == rust) else { continue };
        let start = format!("{} `{}` becomes the Rust type `{rust}`", noun.word(), name.value);
        let headline = format!("{start}, which hides `{hidden}` where you import it");
        let found = HIDES_PRELUDE
            .at(headline, name.span, "")
            .help(format!("choose a name that says whose {} it is", name.value))
            .note("also: option, box, vec, string, some, ok, err, send, sync, drop, clone, default, iterator");
        problems.push(found);
    }
}

/// SCL0314.
pub(crate) const NOT_SNAKE_CASE: Rule = Rule {
    code: "SCL0314",
    severity: Severity::Lint,
    title: "name is not snake_case",
    explanation: "By convention, names are snake_case, like the Rust fields and modules that they become. Other styles \
                  work; the lint is for teams that want one style.",
    example: " components:
-  - name: UserInterface
+  - name: user_interface
+    gates: []
",
};

fn check_snake_case<'m>(model: &'m Model, renames: &Renames<'m>, problems: &mut Diagnostics) {
    let in_programs = names(model).filter(|(noun, name)| *noun != Noun::System && noun.is_well_formed(&name.value));
    for (noun, name) in in_programs {
        let snake = name.value.split('.').map(gate_field).collect::<Vec<_>>().join(".");
        if snake != name.value {
            let headline = format!("{} name `{}` is not snake_case", noun.word(), name.value);
            problems.push(
                NOT_SNAKE_CASE
                    .at(headline, name.span, "")
                    .suggest(format!("write `{snake}`"), renames.edits(noun, name, &snake)),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{HIDES_PRELUDE, NOT_SNAKE_CASE};
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn type_name_hides_a_prelude_type() {
        rule_example(
            &HIDES_PRELUDE,
            expect![[r#"
            warning: [SCL0313] component `result` becomes the Rust type `Result`, which hides `core::result::Result` where you import it
             --> topology.yaml:2:11
              |
            2 |   - name: result
              |           ^^^^^^
              |
              = help: choose a name that says whose result it is
              = note: also: option, box, vec, string, some, ok, err, send, sync, drop, clone, default, iterator
        "#]],
        );
    }

    #[test]
    fn name_is_not_snake_case() {
        rule_example(
            &NOT_SNAKE_CASE,
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
