//! SCL0208: a component without a name.

use crate::diagnostic::Diagnostic;
use crate::parse::component::head;
use crate::parse::fields::Fields;
use crate::parse::shape_word;
use crate::source::SourceFile;
use crate::yaml::{Node, NodeKind};

const CODE: &str = "SCL0208";
const MESSAGE: &str = "this component has no name";

pub(in crate::parse) fn diagnose(item: &Node, fields: &Fields<'_>, source: &SourceFile) -> Diagnostic {
    Diagnostic::error(CODE, MESSAGE, head(item, fields, source), "`name` is missing").help("add `name: ...`")
}

/// `- sensor` or a list in the place of a component.
pub(in crate::parse) fn not_a_mapping(item: &Node) -> Diagnostic {
    let label = format!("{}, where the keys of a component are expected", shape_word(item));
    let problem = Diagnostic::error(CODE, MESSAGE, item.span, label);
    match &item.kind {
        NodeKind::Scalar { text, .. } => problem.help(format!("write `- name: {}`", text.trim())),
        _ => problem.help("write `- name: sensor` and below it `gates:`"),
    }
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components:
  - gates:
      - measurements: pub
";

    #[test]
    fn example() {
        check(
            "SCL0208",
            EXAMPLE,
            expect![[r#"
                error: [SCL0208] this component has no name
                 --> topology.yaml:2:3
                  |
                2 |   - gates:
                  |   ^^^^^^^ `name` is missing
                  |
                  = help: add `name: ...`"#]],
        );
    }
}
