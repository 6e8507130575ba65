//! SCL0113: a YAML tag.

use crate::diagnostic::Diagnostic;
use crate::source::Span;

pub(super) fn diagnose(tag: Span) -> Diagnostic {
    Diagnostic::error("SCL0113", "YAML tags are not supported in a topology", tag, "tag").help("remove the tag")
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components:
  - name: !!python/name:os.system sensor
";

    #[test]
    fn example() {
        check(
            "SCL0113",
            EXAMPLE,
            expect![[r#"
            error: [SCL0113] YAML tags are not supported in a topology
             --> topology.yaml:2:11
              |
            2 |   - name: !!python/name:os.system sensor
              |           ^^^^^^^^^^^^^^^^^^^^^^^ tag
              |
              = help: remove the tag"#]],
        );
    }
}
