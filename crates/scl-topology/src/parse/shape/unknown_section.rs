//! SCL0202: an unknown key at the top level.

use super::{suggest, ticked};
use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::parse::field::Field;
use crate::parse::words::SECTIONS;

/// SCL0202.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0202",
    severity: Severity::Error,
    title: "unknown top-level key",
    explanation: "The key is none of the sections of a topology. An unknown section is mostly a misspelt one, and \
                  would be ignored silently otherwise. Correct it; keys that start with `x-` are yours to use.",
    example: " components: []
-conections: []
+connections: []
",
};

pub(in crate::parse) fn diagnose(field: Field<'_>) -> Diagnostic {
    let message = format!("unknown section `{}`", field.key);
    let problem = RULE.at(message, field.key_span, "not a section of a topology");
    suggest(problem, "section", field.key, SECTIONS)
        .note(format!("sections: {}", ticked(SECTIONS)))
        .note("keys that start with `x-` are ignored, for your own use")
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
                error: [SCL0202] unknown section `conections`
                 --> topology.yaml:2:1
                  |
                2 | conections: []
                  | ^^^^^^^^^^ not a section of a topology
                  |
                  = help: a section with a similar name exists: `connections`
                  = note: sections: `components`, `connections`, `system`, `schemas`, `schema_roots`, `codec`, `scl`
                  = note: keys that start with `x-` are ignored, for your own use"#]],
        );
    }
}
