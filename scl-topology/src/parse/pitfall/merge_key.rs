//! SCL0112: the merge key `<<`.

use crate::diagnostic::Diagnostic;
use crate::yaml::Node;

pub(in crate::parse) fn diagnose(key: &Node) -> Diagnostic {
    let message = "the merge key `<<` is not supported";
    Diagnostic::error("SCL0112", message, key.span, "YAML 1.1 extension, not part of YAML 1.2")
        .help("write the keys out")
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components:
  - name: b
    <<: {gates: []}
";

    #[test]
    fn example() {
        check(
            "SCL0112",
            EXAMPLE,
            expect![[r#"
            error: [SCL0112] the merge key `<<` is not supported
             --> topology.yaml:3:5
              |
            3 |     <<: {gates: []}
              |     ^^ YAML 1.1 extension, not part of YAML 1.2
              |
              = help: write the keys out"#]],
        );
    }
}
