//! Tabs outside of quotes, comments and text blocks. SCL0101: one that indents a line. SCL0129: any other.

use super::scan::{Scan, blank};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::source::SourceFile;
use std::collections::BTreeSet;

/// SCL0101.
pub(crate) const INDENT: Rule = Rule {
    code: "SCL0101",
    severity: Severity::Error,
    title: "tab used for indentation",
    explanation: "A line is indented with a tab. YAML forbids that, because the width of a tab is not defined. Replace \
                  tabs with spaces; editors have a command for it.",
    example: " components:
-\t- name: sensor
+  - name: sensor
+    gates: []
",
};

/// SCL0129.
pub(crate) const SEPARATOR: Rule = Rule {
    code: "SCL0129",
    severity: Severity::Error,
    title: "tab used as white space",
    explanation: "A tab separates two words, ends a line or fills an empty one. YAML allows that, but other readers, \
                  such as PyYAML, reject the file, and a topology file is read by programs in several languages. \
                  Replace the tab with a space; tabs are allowed in quotes and comments.",
    example: " components:
-  - name:\tsensor
+  - name: sensor
     gates: []
",
};

/// The label of every tab.
const LABEL: &str = "this is a tab (shown as 4 spaces)";

/// What to do about tabs, whatever their width.
const HELP: &str = "replace it with spaces; most editors: \"Convert Indentation to Spaces\"";

/// The usual distances of tab stops.
const WIDTHS: [usize; 3] = [2, 4, 8];

/// Reports the first line that is indented with a tab, and how many follow, and replaces the tabs by spaces. Returns
/// true if there are any.
pub(super) fn check_indentation(
    source: &SourceFile,
    scan: &Scan,
    text: &mut String,
    problems: &mut Diagnostics,
) -> bool {
    let tabs = tabs_of_lines(text, |line, start| {
        let content = line.trim_start_matches([' ', '\t']);
        let is_shown = !content.trim().is_empty() && !content.starts_with('#') && !scan.is_quoted(start);
        let indent = if is_shown { line.len() - content.len() } else { 0 };
        (start..start + indent).filter(|at| line.as_bytes()[*at - start] == b'\t').collect()
    });
    let Some(&first) = tabs.first() else { return false };
    let problem = INDENT.at("a tab character is used for indentation", source.span(first..first + 1), LABEL);
    let problem = match is_mixed(text) {
        true => widths(&tabs, text, source).into_iter().fold(problem, |problem, (width, edits)| {
            let is_alike = edits.iter().all(|edit| edit.replacement.len() == width);
            problem.suggest(
                match is_alike {
                    true => format!("replace each tab with {width} spaces"),
                    false => format!("replace each tab with spaces up to the next multiple of {width} columns"),
                },
                edits,
            )
        }),
        false => problem.propose(HELP, tabs.iter().map(|&at| Edit::new(source.span(at..at + 1), "  "))),
    };
    let problem = problem
        .otherwise(HELP)
        .note("YAML forbids tabs in indentation because their width is not defined")
        .notes(count_lines(&tabs, text, source, "are indented with tabs"));
    problems.push(problem);
    blank(text, tabs.iter().map(|&at| at..at + 1));
    true
}

/// Reports the first other tab, and how many lines have one, and replaces these tabs by spaces. Tabs that indent a line
/// are spaces already.
pub(super) fn check_separators(source: &SourceFile, scan: &Scan, text: &mut String, problems: &mut Diagnostics) {
    let tabs = tabs_of_lines(text, |line, start| {
        let in_line = line.match_indices('\t').map(|(at, _)| start + at);
        in_line.filter(|&at| !scan.is_free_text(at)).collect()
    });
    let Some(&first) = tabs.first() else { return };
    let problem = SEPARATOR
        .at("a tab character is used as white space", source.span(first..first + 1), LABEL)
        .propose("replace it with a space", tabs.iter().map(|&at| Edit::new(source.span(at..at + 1), " ")))
        .note("PyYAML and other readers refuse tabs outside of quotes and comments")
        .notes(count_lines(&tabs, text, source, "have such tabs"));
    problems.push(problem);
    blank(text, tabs.iter().map(|&at| at..at + 1));
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
    INDENT
        .at("a tab character stands where only spaces are allowed", source.span(tab..tab + 1), LABEL)
        .suggest("replace it with a space", [Edit::new(source.span(tab..tab + 1), " ")])
        .otherwise(HELP)
}

/// The widths of a tab that put most lines into columns that other lines use, each with its changes.
fn widths(tabs: &[usize], text: &str, source: &SourceFile) -> Vec<(usize, Vec<Edit>)> {
    let indents = text.lines().filter(|line| !line.trim().is_empty());
    let used: BTreeSet<usize> = indents.map(|line| line.len() - line.trim_start_matches(' ').len()).collect();
    let mut ways: Vec<(usize, Vec<Edit>)> = Vec::new();
    for width in WIDTHS {
        let alike = tabs.iter().map(|&at| Edit::new(source.span(at..at + 1), " ".repeat(width))).collect();
        for edits in [expanded(tabs, width, text, source), alike] {
            if ways.iter().all(|(_, other)| *other != edits) {
                ways.push((width, edits));
            }
        }
    }
    let fit = |edits: &[Edit]| {
        let line_of = |edit: &Edit| source.line(edit.span.start as usize);
        let lines = edits.chunk_by(|before, after| line_of(before) == line_of(after));
        let column = |line: &[Edit]| {
            let content = &text[source.line_range(line[0].span.start as usize)];
            let spaces = content.bytes().take_while(|byte| matches!(byte, b' ' | b'\t')).filter(|byte| *byte == b' ');
            spaces.count() + line.iter().map(|edit| edit.replacement.len()).sum::<usize>()
        };
        lines.filter(|line| used.contains(&column(line))).count()
    };
    let most = ways.iter().map(|(_, edits)| fit(edits)).max().unwrap_or_default();
    ways.into_iter().filter(|(_, edits)| fit(edits) == most).collect()
}

/// Tabs as spaces, each up to the next tab stop.
fn expanded(tabs: &[usize], width: usize, text: &str, source: &SourceFile) -> Vec<Edit> {
    let mut edits = Vec::new();
    let (mut line, mut shift) = (0, 0);
    for &at in tabs {
        let start = source.line_range(at).start;
        if start != line {
            (line, shift) = (start, 0);
        }
        let column = text[start..at].len() + shift;
        let spaces = width - column % width;
        shift += spaces - 1;
        edits.push(Edit::new(source.span(at..at + 1), " ".repeat(spaces)));
    }
    edits
}

/// How many lines have tabs, if several do.
fn count_lines(tabs: &[usize], text: &str, source: &SourceFile, what: &str) -> Option<String> {
    let lines = tabs.chunk_by(|before, after| !text[*before..*after].contains('\n')).count();
    let last = source.line(*tabs.last()?);
    (lines > 1).then(|| format!("{lines} lines {what}, up to line {last}"))
}

/// The tabs that `of_line` finds in each line, except for the lines of text blocks. `of_line` gets a line and its
/// start.
fn tabs_of_lines(text: &str, of_line: impl Fn(&str, usize) -> Vec<usize>) -> Vec<usize> {
    let mut tabs = Vec::new();
    if !text.contains('\t') {
        return tabs;
    }
    let mut block: Option<usize> = None;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let spaces = line.len() - line.trim_start_matches(' ').len();
        if block.is_none_or(|parent| !line.trim().is_empty() && spaces <= parent) {
            block = opens_block(line).then_some(spaces);
            tabs.extend(of_line(line, start));
        }
        start += line.len();
    }
    tabs
}

/// Whether a line ends with the `|` or `>` of a text block.
fn opens_block(line: &str) -> bool {
    let line = line.split(" #").next().unwrap_or(line).trim_end();
    let header = line.trim_end_matches(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-'));
    header.ends_with(": |") || header.ends_with(": >") || header.ends_with("- |") || header.ends_with("- >")
}

#[cfg(test)]
mod tests {
    use super::{INDENT, SEPARATOR};
    use crate::parse::testing::{check, headlines};
    use expect_test::expect;

    #[test]
    fn tab_in_an_indentation() {
        check(
            &INDENT,
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

    #[test]
    fn tab_between_words() {
        check(
            &SEPARATOR,
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
