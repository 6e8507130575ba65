//! SCL0312: a name that leaves no room for the others in a socket path.

use super::named::{Noun, names};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Model;

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
            let found = Diagnostic::error("SCL0312", headline, name.span, "")
                .note("names become parts of socket paths, which the kernel limits to 107 bytes (see SCL0801)");
            problems.push(found);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::example;
    use expect_test::expect;

    #[test]
    fn name_too_long() {
        let yaml = r#"
components:
  - name: a_component_name_that_goes_on_and_on_and_on_and_on_and_on_and_on_and_on
"#;
        example(
            "SCL0312",
            yaml.trim_start(),
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
