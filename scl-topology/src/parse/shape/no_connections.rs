//! SCL0206: no connections.

use crate::diagnostic::Diagnostic;
use crate::parse::fields::Field;

/// A warning where gates exist, and `connections` is missing or has no value; `connections: []` is meant.
pub(in crate::parse) fn find(
    components: Field<'_>,
    connections: Option<Field<'_>>,
    gates: usize,
) -> Option<Diagnostic> {
    if gates == 0 || connections.is_some_and(|section| !section.value.is_null()) {
        return None;
    }
    let label =
        if gates == 1 { "1 gate is declared here".to_owned() } else { format!("{gates} gates are declared here") };
    let problem = Diagnostic::warning("SCL0206", "the topology has no connections", components.key_span, label);
    let problem = match connections {
        Some(section) => problem.label(section.key_span, "empty").help("write the connections below it"),
        None => problem.help("add a `connections:` section"),
    };
    Some(problem.help("if the gates are wired later, silence this with `connections: []`"))
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components:
  - name: sensor
    gates:
      - measurements: pub
";

    #[test]
    fn example() {
        check(
            "SCL0206",
            EXAMPLE,
            expect![[r#"
            warning: [SCL0206] the topology has no connections
             --> topology.yaml:1:1
              |
            1 | components:
              | ^^^^^^^^^^ 1 gate is declared here
              |
              = help: add a `connections:` section
              = help: if the gates are wired later, silence this with `connections: []`"#]],
        );
    }
}
