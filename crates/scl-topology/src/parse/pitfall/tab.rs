//! SCL0101: a tab is used for indentation.

use super::scan::Scan;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::source::SourceFile;

/// SCL0101.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0101",
    severity: Severity::Error,
    title: "tab used for indentation",
    explanation: "A line is indented with a tab. YAML forbids that, because nobody knows how wide a tab is. Replace \
                  tabs by spaces; editors have a command for it.",
    example: " components:
-\t- name: sensor
+  - name: sensor
+    gates: []
",
};

/// Reports the first line that is indented with a tab, and how many follow; puts spaces in their place.
pub(in crate::parse) fn check(source: &SourceFile, scan: &Scan, text: &mut String, problems: &mut Diagnostics) -> bool {
    let tabs = indenting_tabs(text, scan);
    let Some(&first) = tabs.first() else { return false };
    let mut problem = diagnose(first, "a tab character is used for indentation", source)
        .note("YAML forbids tabs in indentation because their width is not defined");
    let lines = tabs.chunk_by(|before, after| !text[*before..*after].contains('\n')).count();
    if lines > 1 {
        let last = source.line(tabs.last().copied().unwrap_or(first));
        problem = problem.note(format!("{lines} lines are indented with tabs, up to line {last}"));
    }
    if !is_mixed(text) {
        let with_spaces = |problem: Diagnostic, at: &usize| problem.fix(source.span(*at..*at + 1), "  ");
        problem = tabs.iter().fold(problem, with_spaces);
    }
    problems.push(problem);
    let mut bytes = std::mem::take(text).into_bytes();
    tabs.iter().for_each(|at| bytes[*at] = b' ');
    // One ASCII byte took the place of another, so the text is as valid as before.
    *text = String::from_utf8_lossy(&bytes).into_owned();
    true
}

/// Whether some lines are indented with spaces alone: then the width of a tab is a guess.
fn is_mixed(text: &str) -> bool {
    text.lines().any(|line| line.starts_with(' ') && !line.trim_start_matches(' ').starts_with(['\t', '#']))
}

/// A tab elsewhere, where the parser accepts only spaces.
pub(in crate::parse) fn elsewhere(at: usize, source: &SourceFile) -> Diagnostic {
    let line = source.line_range(at);
    let text = &source.text()[line.clone()];
    let tab = text.find('\t').map_or(at, |found| line.start + found);
    diagnose(tab, "a tab character stands where only spaces are allowed", source)
}

fn diagnose(tab: usize, message: &str, source: &SourceFile) -> Diagnostic {
    RULE.at(message, source.span(tab..tab + 1), "this is a tab (shown as 4 spaces)")
        .help("replace it with spaces; most editors: \"Convert Indentation to Spaces\"")
}

/// Tabs before the first other character of a line. Empty lines, comments, quoted texts and text blocks may have them.
fn indenting_tabs(text: &str, scan: &Scan) -> Vec<usize> {
    let mut tabs = Vec::new();
    let mut block: Option<usize> = None;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let content = line.trim_start_matches([' ', '\t']);
        let indent = line.len() - content.len();
        let spaces = line.len() - line.trim_start_matches(' ').len();
        let is_blank = content.trim().is_empty();
        if block.is_some_and(|parent| is_blank || spaces > parent) {
            start += line.len();
            continue;
        }
        block = opens_block(content).then_some(spaces);
        if !is_blank && !content.starts_with('#') && !scan.is_quoted(start) {
            tabs.extend((start..start + indent).filter(|at| text.as_bytes()[*at] == b'\t'));
        }
        start += line.len();
    }
    tabs
}

/// Whether a line ends with the `|` or `>` of a text block.
pub(in crate::parse) fn opens_block(line: &str) -> bool {
    let line = line.split(" #").next().unwrap_or(line).trim_end();
    let header = line.trim_end_matches(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-'));
    header.ends_with(": |") || header.ends_with(": >") || header.ends_with("- |") || header.ends_with("- >")
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
            error: [SCL0101] a tab character is used for indentation
             --> topology.yaml:2:1
              |
            2 |     - name: sensor
              | ^^^^ this is a tab (shown as 4 spaces)
              |
              = help: replace it with spaces; most editors: "Convert Indentation to Spaces"
              = note: YAML forbids tabs in indentation because their width is not defined"#]],
        );
    }
}
