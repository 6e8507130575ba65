//! SCL0207: an unknown key in a component.

use super::{suggest, ticked};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::Severity;
use crate::parse::component::KEYS;
use crate::parse::fields::Field;
use crate::rule::{Examples, Rule};

/// SCL0207.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0207",
    severity: Severity::Error,
    title: "unknown key in a component",
    explanation: "A component has the keys `name`, `gates`, `doc` and `optional`. Another one is mostly misspelt, and \
                  would be ignored silently otherwise. Correct or remove it.",
    examples: Examples::Topology {
        bad: "components:
  - name: sensor
    gate:
      - measurements: pub
",
        good: "components:
  - name: sensor
    gates:
      - measurements: pub
",
    },
};

pub(in crate::parse) fn diagnose(field: Field<'_>, component: &str) -> Diagnostic {
    let message = format!("unknown key `{}` in component `{component}`", field.key);
    let problem = RULE.at(message, field.key_span, "not a key of a component");
    suggest(problem, "key", field.key, KEYS).note(format!("keys of a component: {}", ticked(KEYS)))
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
            error: [SCL0207] unknown key `gate` in component `sensor`
             --> topology.yaml:3:5
              |
            3 |     gate:
              |     ^^^^ not a key of a component
              |
              = help: a key with a similar name exists: `gates`
              = note: keys of a component: `name`, `gates`, `doc`, `optional`"#]],
        );
    }
}
