//! SCL0312: a name that leaves no room for the others in a socket path.

use super::named::{Noun, names};
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::model::Model;

/// SCL0312.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0312",
    severity: Severity::Error,
    title: "name too long",
    explanation: "Names become parts of socket paths, which the kernel limits to 107 bytes, so a name has at most 64 \
                  characters and a system's at most 40. Shorten it.",
    example: " components:
-  - name: a_component_name_that_goes_on_and_on_and_on_and_on_and_on_and_on_and_on
+  - name: a_short_name
+    gates: []
",
};

/// The longest name of a component or gate, in characters.
const LONGEST_NAME: usize = 64;

/// The longest name of a system: at least 41 bytes of a socket path remain for the names of gates.
const LONGEST_SYSTEM: usize = 40;

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for (noun, name) in names(model) {
        let limit = if noun == Noun::System { LONGEST_SYSTEM } else { LONGEST_NAME };
        let length = name.value.chars().count();
        if length > limit {
            let headline = format!("this name has {length} characters; the limit is {limit}");
            let found = RULE
                .at(headline, name.span, "")
                .note("names become parts of socket paths, which the kernel limits to 107 bytes (see SCL0801)");
            problems.push(found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn name_too_long() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0312] this name has 71 characters; the limit is 64
             --> topology.yaml:2:11
              |
            2 |   - name: a_component_name_that_goes_on_and_on_and_on_and_on_and_on_and_on_and_on
              |           ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
              |
              = note: names become parts of socket paths, which the kernel limits to 107 bytes (see SCL0801)
        "#]],
        );
    }
}
