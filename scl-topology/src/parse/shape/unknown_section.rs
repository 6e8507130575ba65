//! SCL0202: an unknown key at the top level.

use super::{suggest, ticked};
use crate::diagnostic::Diagnostic;
use crate::parse::fields::Field;
use crate::parse::sections::SECTIONS;

pub(in crate::parse) fn diagnose(field: Field<'_>) -> Diagnostic {
    let message = format!("unknown section `{}`", field.key);
    let problem = Diagnostic::error("SCL0202", message, field.key_span, "not a section of a topology");
    suggest(problem, "section", field.key, SECTIONS)
        .note(format!("sections: {}", ticked(SECTIONS)))
        .note("keys that start with `x-` are ignored, for your own use")
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components: []
conections: []
";

    #[test]
    fn example() {
        check(
            "SCL0202",
            EXAMPLE,
            expect![[r#"
            error: [SCL0202] unknown section `conections`
             --> topology.yaml:2:1
              |
            2 | conections: []
              | ^^^^^^^^^^ not a section of a topology
              |
              = help: a section with a similar name exists: `connections`
              = note: sections: `components`, `connections`, `system`, `schemas`, `codec`, `scl`
              = note: keys that start with `x-` are ignored, for your own use"#]],
        );
    }
}
