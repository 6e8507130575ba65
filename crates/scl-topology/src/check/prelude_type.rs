//! SCL0313, a lint: a component whose type hides a name that every Rust file has in scope.

use super::named::is_well_formed;
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::model::Model;
use crate::rust_name::component_type;

/// SCL0313.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0313",
    severity: Severity::Lint,
    title: "type name hides a prelude type",
    explanation: "The component's Rust type has the name of a type that every Rust file knows, such as `Result`. A \
                  program that imports it by name hides the other. Choose a name that says more, or import it under \
                  another.",
    example: " components:
-  - name: result
+  - name: match_result
+    gates: []
",
};

/// Types and where they come from.
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

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for component in model.components.iter().filter(|component| is_well_formed(&component.name.value)) {
        let name = &component.name;
        let rust = component_type(&name.value);
        let Some((_, hidden)) = PRELUDE.iter().find(|(short, _)| *short == rust) else { continue };
        let start = format!("component `{}` becomes the Rust type `{rust}`", name.value);
        let headline = format!("{start}, which hides `{hidden}` where you import it");
        let found = RULE
            .at(headline, name.span, "")
            .help(format!("choose a name that says whose {} it is", name.value))
            .note("also: option, box, vec, string, some, ok, err, send, sync, drop, clone, default, iterator");
        problems.push(found);
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn type_name_hides_a_prelude_type() {
        rule_example(
            &RULE,
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
}
