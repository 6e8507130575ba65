//! SCL0107: a key is written twice.

use crate::diagnostic::Diagnostic;
use crate::parse::fields::Field;
use crate::source::Span;
use crate::yaml::NodeKind;

/// `owner` says whose key it is, for example `this component`.
pub(in crate::parse) fn diagnose(second: &Field<'_>, first: Span, owner: &str) -> Diagnostic {
    let message = format!("the key `{}` is written twice in {owner}", second.key);
    let help = match second.value.kind {
        NodeKind::Sequence { .. } => "merge the two lists",
        _ => "remove one of them",
    };
    Diagnostic::error("SCL0107", message, second.key_span, "second time")
        .label(first, "first time")
        .help(help)
        .note("YAML tools disagree which one wins: PyYAML silently keeps the second")
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components:
  - name: sensor
    gates:
      - measurements: pub
    gates:
      - status: pub
";

    #[test]
    fn example() {
        check(
            "SCL0107",
            EXAMPLE,
            expect![[r#"
            error: [SCL0107] the key `gates` is written twice in this component
             --> topology.yaml:5:5
              |
            3 |     gates:
              |     ----- first time
            4 |       - measurements: pub
            5 |     gates:
              |     ^^^^^ second time
              |
              = help: merge the two lists
              = note: YAML tools disagree which one wins: PyYAML silently keeps the second"#]],
        );
    }
}
