//! SCL0122: no comma between two entries in brackets. SCL0123: no colon after a key.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::SourceFile;
use std::ops::Range;

/// SCL0122.
pub(crate) const COMMA: Rule = Rule {
    code: "SCL0122",
    severity: Severity::Error,
    title: "missing comma",
    explanation: "In brackets and braces, a comma separates the entries. Without it, or with another character in its \
                  place, YAML reads two entries as one. Write the comma.",
    example: " components:
   - name: controller
     gates:
-      - sensor: {sub: Measurement queue: 4}
+      - sensor: {sub: Measurement, queue: 4, unconnected: ok}
",
};

/// No comma between two words.
pub(in crate::parse) fn comma_between(
    before: &Range<usize>,
    after: &Range<usize>,
    text: &str,
    source: &SourceFile,
) -> Diagnostic {
    let (first, second) = (&text[before.clone()], &text[after.clone()]);
    let message = format!("a comma is missing before {}", described(second));
    let help = match first {
        ":" => format!("add `,` before `{second}`"),
        _ => format!("add `,` after `{first}`"),
    };
    match source.line(before.start) == source.line(after.start) {
        true => COMMA.at(message, source.span(after.clone()), "a new entry starts here").help(help),
        false => COMMA
            .at(message, source.span(before.clone()), "no comma after this")
            .label(source.span(after.clone()), "a new entry starts here")
            .help(help),
    }
}

/// Another mark in the place of a comma.
pub(in crate::parse) fn instead_of_comma(mark: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let message = format!("`{}` does not separate entries", &text[mark.clone()]);
    COMMA.at(message, source.span(mark.clone()), "expected a comma").help("write `,`")
}

fn described(word: &str) -> String {
    match word {
        "{" | "[" => format!("this `{word}`"),
        _ => format!("`{word}`"),
    }
}

/// SCL0123.
pub(crate) const COLON: Rule = Rule {
    code: "SCL0123",
    severity: Severity::Error,
    title: "missing `:` after a key",
    explanation: "A key and its value are separated by a colon and a space. Here the colon is missing, or another \
                  character was written instead. Write the colon.",
    example: "-components
+components:
   - name: sensor
     gates: []
",
};

/// No colon after a word.
pub(in crate::parse) fn colon_after(word: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let key = &text[word.clone()];
    COLON.at(format!("missing `:` after `{key}`"), source.span(word.clone()), "a key").help(format!("write `{key}:`"))
}

/// Another mark in the place of a colon.
pub(in crate::parse) fn instead_of_colon(mark: &Range<usize>, text: &str, source: &SourceFile) -> Diagnostic {
    let found = &text[mark.clone()];
    let line = source.line_range(mark.start);
    let key = text[line.start..mark.start].trim_end().rsplit([' ', ',', '{']).next().unwrap_or("");
    let value = text[mark.end..line.end].trim_start().split([',', '}']).next().unwrap_or("").trim_end();
    COLON
        .at(format!("`{found}` stands where a colon is expected"), source.span(mark.clone()), "expected `:`")
        .help(format!("write `{key}: {value}`"))
}

#[cfg(test)]
mod tests {
    use super::{COLON, COMMA};
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn missing_comma() {
        check(
            &COMMA,
            expect![[r#"
            error: [SCL0122] a comma is missing before `queue`
             --> topology.yaml:4:35
              |
            4 |       - sensor: {sub: Measurement queue: 4}
              |                                   ^^^^^ a new entry starts here
              |
              = help: add `,` after `Measurement`"#]],
        );
    }

    #[test]
    fn missing_colon() {
        check(
            &COLON,
            expect![[r#"
            error: [SCL0123] missing `:` after `components`
             --> topology.yaml:1:1
              |
            1 | components
              | ^^^^^^^^^^ a key
              |
              = help: write `components:`"#]],
        );
    }
}
