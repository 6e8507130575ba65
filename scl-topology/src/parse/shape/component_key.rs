//! SCL0207: an unknown key in a component.

use super::{suggest, ticked};
use crate::diagnostic::Diagnostic;
use crate::parse::component::KEYS;
use crate::parse::fields::Field;

pub(in crate::parse) fn diagnose(field: Field<'_>, component: &str) -> Diagnostic {
    let message = format!("unknown key `{}` in component `{component}`", field.key);
    let problem = Diagnostic::error("SCL0207", message, field.key_span, "not a key of a component");
    suggest(problem, "key", field.key, KEYS).note(format!("keys of a component: {}", ticked(KEYS)))
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components:
  - name: sensor
    gate:
      - measurements: pub
";

    #[test]
    fn example() {
        check(
            "SCL0207",
            EXAMPLE,
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
