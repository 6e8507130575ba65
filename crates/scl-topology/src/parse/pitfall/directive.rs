//! SCL0118: a YAML directive, such as `%YAML 1.1`.

use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::source::SourceFile;
use std::ops::Range;

/// SCL0118.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0118",
    severity: Severity::Error,
    title: "YAML directive",
    explanation: "Lines that start with `%` are orders to the YAML parser. A topology is always read as YAML 1.2, so \
                  it has none. Remove the line and the `---` below it.",
    example: "-%YAML 1.1
----
 components: []
",
};

/// Reports the directives before the document, and puts spaces in their place.
pub(in crate::parse) fn check(source: &SourceFile, text: &mut String, problems: &mut Diagnostics) {
    let directives = leading_directives(text);
    for directive in &directives {
        problems.push(diagnose(source, directive.start));
        text.replace_range(directive.clone(), &" ".repeat(directive.len()));
    }
}

pub(in crate::parse) fn diagnose(source: &SourceFile, at: usize) -> Diagnostic {
    let range = source.line_range(at);
    let line = source.line(at);
    let marker = source.text()[range.end..].trim_start().starts_with("---");
    let help = if marker { format!("remove lines {line} and {}", line + 1) } else { format!("remove line {line}") };
    let text = source.text();
    let end = range.end + text[range.end..].find('\n').map_or(0, |at| at + 1);
    let with_marker = text[end..].find('\n').filter(|_| marker && text[end..].starts_with("---"));
    let removed = source.span(range.start..end + with_marker.map_or(0, |at| at + 1));
    RULE.at("YAML directives are not supported", source.span(range), "directive")
        .help(help)
        .fix(removed, "")
        .note("a topology is read as YAML 1.2; see SCL0108 for the words that differ")
}

/// Lines that start with `%` before anything else than comments.
fn leading_directives(text: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let content = line.trim_end();
        if content.starts_with('%') {
            found.push(start..start + content.len());
        } else if !content.is_empty() && !content.starts_with('#') {
            break;
        }
        start += line.len();
    }
    found
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
            error: [SCL0118] YAML directives are not supported
             --> topology.yaml:1:1
              |
            1 | %YAML 1.1
              | ^^^^^^^^^ directive
              |
              = help: remove lines 1 and 2
              = note: a topology is read as YAML 1.2; see SCL0108 for the words that differ"#]],
        );
    }
}
