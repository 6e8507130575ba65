//! SCL0116: nested too deeply.

use crate::diagnostic::Diagnostic;
use crate::source::Span;
use crate::yaml::MAX_DEPTH;

pub(super) fn diagnose(at: Span) -> Diagnostic {
    let message = format!("the file is nested more than {MAX_DEPTH} levels deep here");
    Diagnostic::error("SCL0116", message, at, format!("level {}", MAX_DEPTH + 1))
        .note("a topology needs 6 levels; the limit keeps the compiler from overflowing its stack")
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components: [[[[[[[[[[[[[[[[[x]]]]]]]]]]]]]]]]]
";

    #[test]
    fn example() {
        check(
            "SCL0116",
            EXAMPLE,
            expect![[r#"
            error: [SCL0116] the file is nested more than 16 levels deep here
             --> topology.yaml:1:28
              |
            1 | components: [[[[[[[[[[[[[[[[[x]]]]]]]]]]]]]]]]]
              |                            ^ level 17
              |
              = note: a topology needs 6 levels; the limit keeps the compiler from overflowing its stack"#]],
        );
    }
}
