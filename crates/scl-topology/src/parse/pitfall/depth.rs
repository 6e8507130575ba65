//! SCL0116: nested too deeply.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::parse::dialect::Dialect;
use crate::source::Span;
use crate::yaml::MAX_DEPTH;

/// SCL0116.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0116",
    severity: Severity::Error,
    title: "nested too deeply",
    explanation: "A topology needs 6 levels of nesting; this file has more than 16. The limit keeps the programs that \
                  read the file, above all the compiler, from overflowing their stack. Remove the extra levels.",
    example: "-components: [[[[[[[[[[[[[[[[[x]]]]]]]]]]]]]]]]]
+components: []
",
};

pub(in crate::parse) fn diagnose(at: Span, dialect: &Dialect) -> Diagnostic {
    let message = format!("the file is nested more than {MAX_DEPTH} levels deep here");
    RULE.at(message, at, format!("level {}", MAX_DEPTH + 1)).note(format!(
        "a {} needs {} levels; the limit keeps programs that read it from overflowing their stack",
        dialect.noun, dialect.levels
    ))
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
            error: [SCL0116] the file is nested more than 16 levels deep here
             --> topology.yaml:1:28
              |
            1 | components: [[[[[[[[[[[[[[[[[x]]]]]]]]]]]]]]]]]
              |                            ^ level 17
              |
              = note: a topology needs 6 levels; the limit keeps programs that read it from overflowing their stack"#]],
        );
    }
}
