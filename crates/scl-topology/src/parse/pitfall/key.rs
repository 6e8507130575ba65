//! SCL0107: a key is written twice. SCL0120: a key that is no plain word.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::parse::field::Field;
use crate::source::Span;
use crate::yaml::{Node, NodeKind};

/// SCL0107.
pub(crate) const DUPLICATE: Rule = Rule {
    code: "SCL0107",
    severity: Severity::Error,
    title: "duplicate key",
    explanation: "The same key is written twice in one mapping. YAML tools disagree on which one wins, and some say \
                  nothing about it. Merge the two values, or remove one.",
    example: " components:
   - name: sensor
     gates:
       - measurements: pub
-    gates:
       - status: pub
",
};

/// A key that is written twice. `owner` says whose key it is, for example `this component`.
pub(in crate::parse) fn duplicate(second: &Field<'_>, first: Span, owner: &str) -> Diagnostic {
    let message = format!("the key `{}` is written twice in {owner}", second.key);
    let help = match second.value.kind {
        NodeKind::Sequence { .. } if second.key == "gates" => {
            "merge the two lists, or write the `- name: ...` of another component above the second"
        }
        NodeKind::Sequence { .. } => "merge the two lists",
        NodeKind::Mapping { .. } => "merge the two into one, or remove one of them",
        _ => "remove one of them",
    };
    DUPLICATE
        .at(message, second.key_span, "second time")
        .label(first, "first time")
        .help(help)
        .note("YAML tools disagree which one wins: PyYAML silently keeps the second")
}

/// SCL0120.
pub(crate) const NOT_A_WORD: Rule = Rule {
    code: "SCL0120",
    severity: Severity::Error,
    title: "key is not a plain word",
    explanation: "YAML allows lists, mappings and null as keys. In a topology, each key is a plain word. Write one.",
    example: " components:
-  - ? [a, b]
-    : pub
+  - name: sensor
+    gates:
+      - measurements: pub
+connections: []
",
};

pub(in crate::parse) fn not_a_word(key: &Node) -> Diagnostic {
    let label = format!("this key is {}", crate::parse::shape_word(key));
    NOT_A_WORD.at("a key must be a plain word", key.span, label)
}

#[cfg(test)]
mod tests {
    use super::{DUPLICATE, NOT_A_WORD};
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn duplicate_key() {
        check(
            &DUPLICATE,
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

    #[test]
    fn odd_key() {
        check(
            &NOT_A_WORD,
            expect![[r#"
            error: [SCL0120] a key must be a plain word
             --> topology.yaml:2:7
              |
            2 |   - ? [a, b]
              |       ^^^^^^ this key is a list"#]],
        );
    }
}
