//! SCL0206: no connections.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::parse::field::Field;

/// SCL0206.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0206",
    severity: Severity::Warning,
    title: "no connections",
    explanation: "Gates are declared, and none of them is connected. Add the section `connections`. If the wiring \
                  follows later, write `connections: []`, which says so.",
    example: " components:
   - name: sensor
     gates:
       - measurements: pub
+connections: []
",
};

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
    let problem = RULE.at("the topology has no connections", components.key_span, label);
    let problem = match connections {
        Some(section) => problem.label(section.key_span, "empty").help("write the connections below it"),
        None => problem.help("add a `connections:` section"),
    };
    Some(problem.help("if the gates are wired later, silence this with `connections: []`"))
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
