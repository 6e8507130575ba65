//! SCL0205: the section `components` is empty.

use crate::diagnostic::Diagnostic;
use crate::parse::fields::Field;

/// An explicit `components: []` is meant, as it is for gates and connections.
pub(in crate::parse) fn diagnose(section: Field<'_>) -> Diagnostic {
    Diagnostic::error("SCL0205", "the topology has no components", section.key_span, "the section is empty")
        .help("add at least one component")
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components:
connections: []
";

    #[test]
    fn example() {
        check(
            "SCL0205",
            EXAMPLE,
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
