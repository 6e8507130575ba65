//! SCL0213: a format version that this version of scl does not read.

use super::option_value::{self, replacement};
use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::grammar::{FORMAT, Shape, is_whole_number};
use crate::parse::field::Field;
use crate::parse::pitfall::leading_zero;
use crate::source::SourceFile;
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

pub(in crate::parse) fn find(field: Field<'_>, source: &SourceFile) -> Option<Diagnostic> {
    match &field.value.kind {
        NodeKind::Unread => None,
        NodeKind::Scalar { text, .. } if field.value.is_plain() && *text == FORMAT.to_string() => None,
        NodeKind::Scalar { text, .. } if field.value.is_plain() && is_whole_number(text) => {
            Some(leading_zero::find(field, text).unwrap_or_else(|| unsupported(field, text)))
        }
        _ => {
            let problem = option_value::diagnose(field, Shape::Number { least: FORMAT, most: FORMAT }, source);
            if problem.proposals().next().is_some() {
                return Some(problem);
            }
            let text = format!("the version of the format is {FORMAT}, whatever that of scl: write `scl: {FORMAT}`");
            Some(problem.suggest(text, [replacement(field, &FORMAT.to_string())]))
        }
    }
}

fn unsupported(field: Field<'_>, version: &str) -> Diagnostic {
    let message = format!("this file needs topology format {version}; this version of scl reads format {FORMAT}");
    let own = env!("CARGO_PKG_VERSION");
    let problem = RULE.at(message, field.value.span, "");
    match version.parse::<u32>() {
        Ok(version) if version > FORMAT => problem.help(format!("a later version of scl than {own} is needed")),
        _ => problem,
    }
    .suggest(
        format!("if the file has format {FORMAT}, write `scl: {FORMAT}`"),
        [replacement(field, &FORMAT.to_string())],
    )
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
                  = help: a later version of scl than 0.1.0 is needed
                  = help: if the file has format 1, write `scl: 1`"#]],
        );
    }
}
