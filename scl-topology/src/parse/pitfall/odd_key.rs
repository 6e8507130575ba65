//! SCL0120: a key that is no plain word.

use crate::diagnostic::Diagnostic;
use crate::yaml::Node;

pub(in crate::parse) fn diagnose(key: &Node) -> Diagnostic {
    let label = format!("this key is {}", crate::parse::shape_word(key));
    Diagnostic::error("SCL0120", "a key must be a plain word", key.span, label)
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components:
  - ? [a, b]
    : pub
";

    #[test]
    fn example() {
        check(
            "SCL0120",
            EXAMPLE,
            expect![[r#"
            error: [SCL0120] a key must be a plain word
             --> topology.yaml:2:7
              |
            2 |   - ? [a, b]
              |       ^^^^^^ this key is a list"#]],
        );
    }
}
