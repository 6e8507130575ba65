//! SCL0216: a connection in the list of components.

use crate::diagnostic::{Diagnostic, Edit, Rule, Severity, removal};
use crate::parse::field::{Field, end_with_colon};
use crate::parse::{scalar, with_dash};
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, NodeKind};

/// SCL0216.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0216",
    severity: Severity::Error,
    title: "connection in the list of components",
    explanation: "The list of components contains a pair of gates, usually because the line `connections:` is missing \
                  or commented out. Write `connections:` above the first pair, at the start of the line.",
    example: " components:
   - name: sensor
     gates:
       - measurements: pub
   - name: controller
     gates:
       - sensor: sub
+connections:
   - [sensor.measurements, controller.sensor]
",
};

/// Whether a list item looks like a connection and not like a component.
pub(in crate::parse) fn is_pair(item: &Node) -> bool {
    let is_end = |node: &Node| scalar(node).is_some_and(|end| end.value.contains('.'));
    matches!(&item.kind, NodeKind::Sequence { items } if !items.is_empty() && items.iter().any(is_end))
}

pub(in crate::parse) fn diagnose(item: &Node, source: &SourceFile) -> Diagnostic {
    let span = with_dash(item.span, source);
    let line = source.line_range(span.start as usize);
    let (line, end) = (line.start as u32, span.end.min(line.end as u32));
    RULE.at("this list of pairs has no `connections:` above it", Span { end, ..span }, "a connection, not a component")
        .propose(
            "add the line `connections:` above it, starting in column 1",
            [Edit::new(Span { start: line, end: line, ..span }, "connections:\n")],
        )
}

/// Changes such a problem to say that the section exists, below the pairs. Always returns true, to keep every problem.
pub(in crate::parse) fn with_section(problem: &mut Diagnostic, section: Field<'_>, source: &SourceFile) -> bool {
    if *problem.rule == RULE {
        problem.message = "this connection stands above `connections:`".to_owned();
        let above: Vec<Edit> = problem.proposals().flat_map(|way| way.edits.clone()).collect();
        problem.clear_helps();
        let key = Span { end: end_with_colon(section.key_span, source), ..section.key_span };
        let moved = problem.clone();
        *problem = match removal(source, key).filter(|_| section.value.is_null()) {
            Some(line) => moved.suggest("move the line `connections:` above it", above.into_iter().chain([line])),
            None => moved.help("connections stand below `connections:`"),
        };
    }
    true
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
            error: [SCL0216] this list of pairs has no `connections:` above it
             --> topology.yaml:8:3
              |
            8 |   - [sensor.measurements, controller.sensor]
              |   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ a connection, not a component
              |
              = help: add the line `connections:` above it, starting in column 1"#]],
        );
    }
}
