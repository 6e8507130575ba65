//! SCL0107: a key is written twice.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::parse::field::Field;
use crate::source::Span;
use crate::yaml::NodeKind;

/// SCL0107.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0107",
    severity: Severity::Error,
    title: "duplicate key",
    explanation: "A key is written twice in one place. YAML tools disagree which of the two counts, some of them \
                  silently. Merge the two values, or remove one.",
    example: " components:
   - name: sensor
     gates:
       - measurements: pub
-    gates:
       - status: pub
",
};

/// `owner` says whose key it is, for example `this component`.
pub(in crate::parse) fn diagnose(second: &Field<'_>, first: Span, owner: &str) -> Diagnostic {
    let message = format!("the key `{}` is written twice in {owner}", second.key);
    let help = match second.value.kind {
        NodeKind::Sequence { .. } if second.key == "gates" => {
            "merge the two lists, or write the `- name: ...` of another component above the second"
        }
        NodeKind::Sequence { .. } => "merge the two lists",
        _ => "remove one of them",
    };
    RULE.at(message, second.key_span, "second time")
        .label(first, "first time")
        .help(help)
        .note("YAML tools disagree which one wins: PyYAML silently keeps the second")
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
                error: [SCL0107] the key `gates` is written twice in this component
                 --> topology.yaml:5:5
                  |
                3 |     gates:
                  |     ----- first time
                4 |       - measurements: pub
                5 |     gates:
                  |     ^^^^^ second time
                  |
                  = help: merge the two lists, or write the `- name: ...` of another component above the second
                  = note: YAML tools disagree which one wins: PyYAML silently keeps the second"#]],
        );
    }
}
