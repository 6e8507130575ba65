//! SCL0119: a text block where a name belongs.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::{SourceFile, Span};
use crate::yaml::Node;

/// SCL0119.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0119",
    severity: Severity::Error,
    title: "text block used as a name",
    explanation: "`|` and `>` start a text of several lines, whose value ends with a line break. A name stands on one \
                  line. Write it behind its key.",
    example: " components:
-  - name: |
-      sensor
+  - name: sensor
+    gates: []
",
};

pub(in crate::parse) fn diagnose(node: &Node, text: &str, source: &SourceFile) -> Diagnostic {
    let end = if text.ends_with('\n') { " with a line break" } else { "" };
    let label = format!("this starts a text block; its value is {text:?}{end}");
    let problem = RULE.at("a name must be written on one line", header(node, source), label);
    let name = text.trim();
    if name.contains('\n') {
        return problem;
    }
    let block = header(node, source).to(node.span);
    // The block ends with its last line break, which stays.
    let whole = source.snippet(block);
    let end = block.start + whole.trim_end().len() as u32;
    problem.help(format!("write `{}`", written(node, name, source))).fix(Span { end, ..block }, name)
}

/// The `|` or `>`, in the line above the text.
fn header(node: &Node, source: &SourceFile) -> Span {
    let before = source.text().get(..node.span.start as usize).unwrap_or("").trim_end();
    let line = source.line_range(before.len()).start;
    let found = before.get(line..).and_then(|above| above.find(['|', '>']));
    found.map_or(node.span, |at| {
        let start = (line + at) as u32;
        Span { start, end: start + 1, ..node.span }
    })
}

/// The key of the header's line, and the name after it.
fn written(node: &Node, name: &str, source: &SourceFile) -> String {
    let header = header(node, source).start as usize;
    let line = source.line_range(header).start;
    let before = source.text().get(line..header).unwrap_or("");
    format!("{}{name}", before.trim_start_matches([' ', '-']))
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
            error: [SCL0119] a name must be written on one line
             --> topology.yaml:2:11
              |
            2 |   - name: |
              |           ^ this starts a text block; its value is "sensor\n" with a line break
              |
              = help: write `name: sensor`"#]],
        );
    }
}
