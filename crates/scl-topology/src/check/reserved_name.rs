//! SCL0311: names that the framework keeps for itself, so that it can grow without breaking a file. SCL0312: a name
//! that leaves no room for the others in a socket path.

use super::named::{LONGEST_NAME, Noun, names};
use super::rename::Renames;
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::model::Model;

/// SCL0311.
pub(crate) const RESERVED: Rule = Rule {
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

/// SCL0312.
pub(crate) const TOO_LONG: Rule = Rule {
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

/// The longest name of a system: at least 41 bytes of a socket path remain for the names of gates.
const LONGEST_SYSTEM: usize = 40;

pub(super) fn check<'m>(model: &'m Model, renames: &Renames<'m>, problems: &mut Diagnostics) {
    for (noun, name) in names(model) {
        if is_reserved(noun, &name.value) {
            let found = RESERVED
                .at(format!("`{}` is reserved for the framework", name.value), name.span, "")
                .suggest(
                    format!("choose another name, for example `{}`", other_name(&name.value)),
                    renames.edits(noun, name, &other_name(&name.value)),
                )
                .otherwise("choose another name")
                .note("reserved: `scl`, `topology`, and names that start with `scl_` or `__`");
            problems.push(found);
        }
        let limit = if noun == Noun::System { LONGEST_SYSTEM } else { LONGEST_NAME };
        let length = name.value.chars().count();
        if length > limit {
            let headline = format!("this name has {length} characters; the limit is {limit}");
            let found = TOO_LONG
                .at(headline, name.span, "")
                .note("names become parts of socket paths, which the kernel limits to 107 bytes (see SCL0801)");
            problems.push(found);
        }
    }
}

fn is_reserved(noun: Noun, name: &str) -> bool {
    // In programs, `scl.planner` becomes `scl_planner`.
    let name = name.replace('.', "_");
    match noun {
        // A system's name only becomes a folder, so no name is reserved; `topology` is the usual default.
        Noun::System => false,
        Noun::Kind | Noun::Component => {
            name == "scl" || name == "topology" || name.starts_with("scl_") || name.starts_with("__")
        }
        Noun::Gate | Noun::Parameter => name.starts_with("__"),
    }
}

/// A name without the reserved part, or with another word.
fn other_name(name: &str) -> String {
    let bare = name.trim_start_matches('_');
    let bare = bare.strip_prefix("scl_").or(bare.strip_prefix("scl.")).unwrap_or(bare).trim_start_matches('_');
    match bare {
        "" | "scl" | "topology" => format!("my_{bare}").trim_end_matches('_').to_owned(),
        _ => bare.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{RESERVED, TOO_LONG};
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn reserved_name() {
        rule_example(
            &RESERVED,
            expect![[r#"
                error: [SCL0311] `scl` is reserved for the framework
                 --> topology.yaml:2:11
                  |
                2 |   - name: scl
                  |           ^^^
                  |
                  = help: choose another name, for example `my_scl`
                  = note: reserved: `scl`, `topology`, and names that start with `scl_` or `__`
            "#]],
        );
    }

    #[test]
    fn name_too_long() {
        rule_example(
            &TOO_LONG,
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
