//! SCL0129: a tab outside of quotes, comments and text blocks that does not indent a line.

use super::{scan::Scan, tab::opens_block};
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::source::SourceFile;

/// SCL0129.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0129",
    severity: Severity::Error,
    title: "tab used as white space",
    explanation: "A tab separates two words, ends a line or fills an empty one. YAML allows that, but other readers, \
                  such as PyYAML, refuse the file. A topology file is read by programs in several languages. Replace \
                  the tab by a space; in quotes and comments tabs are allowed.",
    example: " components:
-  - name:\tsensor
+  - name: sensor
     gates: []
",
};

/// Reports the first such tab, and how many lines have one; puts spaces in their place.
pub(super) fn check(source: &SourceFile, scan: &Scan, text: &mut String, problems: &mut Diagnostics) {
    let tabs = separating_tabs(text, scan);
    let Some(&first) = tabs.first() else { return };
    let mut problem = RULE
        .at(
            "a tab character is used as white space",
            source.span(first..first + 1),
            "this is a tab (shown as 4 spaces)",
        )
        .help("replace it with a space")
        .note("PyYAML and other readers refuse tabs outside of quotes and comments");
    let lines = tabs.chunk_by(|before, after| !text[*before..*after].contains('\n')).count();
    if lines > 1 {
        let last = source.line(tabs.last().copied().unwrap_or(first));
        problem = problem.note(format!("{lines} lines have such tabs, up to line {last}"));
    }
    problems.push(tabs.iter().fold(problem, |problem, &at| problem.fix(source.span(at..at + 1), " ")));
    let mut bytes = std::mem::take(text).into_bytes();
    tabs.iter().for_each(|at| bytes[*at] = b' ');
    // One ASCII byte took the place of another, so the text is as valid as before.
    *text = String::from_utf8_lossy(&bytes).into_owned();
}

/// Tabs in the order of the text. Those that indent a line are spaces already.
fn separating_tabs(text: &str, scan: &Scan) -> Vec<usize> {
    let mut tabs = Vec::new();
    if !text.contains('\t') {
        return tabs;
    }
    let mut block: Option<usize> = None;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let spaces = line.len() - line.trim_start_matches(' ').len();
        let is_blank = line.trim().is_empty();
        if block.is_none_or(|parent| !is_blank && spaces <= parent) {
            block = opens_block(line).then_some(spaces);
            let in_line = line.match_indices('\t').map(|(at, _)| start + at);
            tabs.extend(in_line.filter(|&at| !scan.is_free_text(at)));
        }
        start += line.len();
    }
    tabs
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
                error: [SCL0129] a tab character is used as white space
                 --> topology.yaml:2:10
                  |
                2 |   - name:    sensor
                  |          ^^^^ this is a tab (shown as 4 spaces)
                  |
                  = help: replace it with a space
                  = note: PyYAML and other readers refuse tabs outside of quotes and comments"#]],
        );
    }

    #[test]
    fn tabs_in_texts_are_fine() {
        let text = "components: #\ta\n  - name: a\n    doc: |\n      x\ty\n\n      z\t\n    gates: [{x: {pub: T, doc: \"a\tb\"}}]\n\
                    connections: []\n";
        assert_eq!(headlines(text), "");
        let text = text.replace("gates: [", "gates:\t[").replace("x: {pub", "x:\t{pub").replace("[]\n", "[]\t\n\t\n");
        expect![[r#"
            SCL0129 7:11 a tab character is used as white space
        "#]]
        .assert_eq(&headlines(&text));
    }
}
