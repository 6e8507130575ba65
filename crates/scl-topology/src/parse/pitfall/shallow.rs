//! SCL0132: lines in brackets that are indented less than the line with the opening bracket.

use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::source::SourceFile;
use crate::yaml::{Node, NodeKind};

/// SCL0132.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0132",
    severity: Severity::Error,
    title: "continuation that is not indented",
    explanation: "What stands in brackets may go on in further lines, but YAML 1.2 requires that they are indented at \
                  least as deep as the line in which the bracket opens. Some readers do not mind, others refuse the \
                  file. Indent the lines.",
    example: " components:
   - name: sensor
     gates: [measurements: {pub: , unconnected: ok},
-  status: {pub: , unconnected: ok}]
+      status: {pub: , unconnected: ok}]
",
};

/// Finds the lists and mappings in brackets with such lines. The depth of the tree bounds the recursion.
pub(super) fn find(node: &Node, source: &SourceFile, problems: &mut Vec<Diagnostic>) {
    let is_flow = source.snippet(node.span).starts_with(['[', '{']);
    match &node.kind {
        NodeKind::Sequence { .. } | NodeKind::Mapping { .. } if is_flow => problems.extend(check(node, source)),
        NodeKind::Sequence { items } => items.iter().for_each(|item| find(item, source, problems)),
        NodeKind::Mapping { entries } => entries.iter().for_each(|(_, value)| find(value, source, problems)),
        _ => {}
    }
}

fn check(node: &Node, source: &SourceFile) -> Option<Diagnostic> {
    let indent_of = |line: &str| line.len() - line.trim_start_matches(' ').len();
    let text = source.text();
    let (start, end) = (node.span.start as usize, node.span.end as usize);
    let head = source.line_range(start);
    let indent = indent_of(&text[head.clone()]);
    if end <= head.end || indent == 0 {
        return None;
    }
    let mut edits = Vec::new();
    let mut first = None;
    let mut at = head.end + text[head.end..].find('\n')? + 1;
    for line in text[at..end].split_inclusive('\n') {
        let content = line.trim();
        let own = indent_of(line);
        if own < indent && !content.is_empty() && !content.starts_with('#') {
            let deeper = if content.starts_with([']', '}']) { indent } else { indent + 2 };
            edits.push(Edit::new(source.span(at..at + own), " ".repeat(deeper)));
            first.get_or_insert(at + own..at + line.trim_end().len());
        }
        at += line.len();
    }
    let bracket = &text[start..start + 1];
    let help = match edits.len() {
        1 => format!("indent it by {} spaces", edits.first()?.replacement.len()),
        _ => format!("indent the lines below `{bracket}` by {} spaces", indent + 2),
    };
    let problem = RULE
        .at(format!("this line continues what `{bracket}` opens, and is indented less"), source.span(first?), "")
        .label(source.span(start..start + 1), "opened here");
    Some(problem.propose(help, edits))
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::parse::testing::{check, headlines};
    use expect_test::expect;

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
            error: [SCL0132] this line continues what `[` opens, and is indented less
             --> topology.yaml:4:3
              |
            3 |     gates: [measurements: {pub: , unconnected: ok},
              |            - opened here
            4 |   status: {pub: , unconnected: ok}]
              |   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
              |
              = help: indent it by 6 spaces"#]],
        );
    }

    #[test]
    fn a_closing_bracket_may_stand_below_its_line() {
        for text in [
            "components: [\n]\nconnections: []\n",
            "components:\n  - name: a\n    gates: [\n      x: pub\n    ]\nconnections: []\n",
            "{\n\"components\": [],\n\"connections\": []\n}\n",
        ] {
            assert_eq!(headlines(text), "", "{text}");
        }
    }
}
