//! SCL0213: a format version that this version of scl does not read.

use super::option_value;
use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::grammar::{FORMAT, Shape, is_whole_number};
use crate::parse::field::Field;
use crate::parse::pitfall::leading_zero;
use crate::yaml::NodeKind;

/// SCL0213.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0213",
    severity: Severity::Error,
    title: "unsupported format version",
    explanation: "`scl:` names a version of the file format that this version of scl does not support. Update scl, or \
                  write the file in a format that it supports.",
    example: "-scl: 3
+scl: 1
 components: []
",
};

pub(in crate::parse) fn find(field: Field<'_>) -> Option<Diagnostic> {
    match &field.value.kind {
        NodeKind::Unread => None,
        NodeKind::Scalar { text, .. } if field.value.is_plain() && *text == FORMAT.to_string() => None,
        NodeKind::Scalar { text, .. } if field.value.is_plain() && is_whole_number(text) => {
            Some(leading_zero::find(field, text).unwrap_or_else(|| unsupported(field, text)))
        }
        _ => Some(option_value::diagnose(field, Shape::Number { least: FORMAT, most: FORMAT })),
    }
}

fn unsupported(field: Field<'_>, version: &str) -> Diagnostic {
    let message = format!("this file needs topology format {version}; this version of scl reads format {FORMAT}");
    let own = env!("CARGO_PKG_VERSION");
    RULE.at(message, field.value.span, "")
        .help(format!("update the `scl` crate (this is scl {own}), or use format {FORMAT}"))
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
            error: [SCL0213] this file needs topology format 3; this version of scl reads format 1
             --> topology.yaml:1:6
              |
            1 | scl: 3
              |      ^
              |
              = help: update the `scl` crate (this is scl 0.1.0), or use format 1"#]],
        );
    }
}
