//! SCL0114: more than one document.

use super::Place;
use crate::diagnostic::Diagnostic;
use crate::source::Span;

/// The parser may place the start of a document without `---` at its content.
pub(super) fn diagnose(place: &Place<'_>, at: Span) -> Diagnostic {
    let rest = place.source.text().get(at.start as usize..).unwrap_or("");
    let marker = rest.starts_with("---");
    let help = if marker { "remove the `---` line" } else { "remove the `...` line above" };
    let span = if marker { Span { end: at.start + 3, ..at } } else { at };
    Diagnostic::error("SCL0114", "a topology is one YAML document; a second one starts here", span, "second document")
        .help(help)
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components: []
---
connections: []
";

    #[test]
    fn example() {
        check(
            "SCL0114",
            EXAMPLE,
            expect![[r#"
            error: [SCL0114] a topology is one YAML document; a second one starts here
             --> topology.yaml:2:1
              |
            2 | ---
              | ^^^ second document
              |
              = help: remove the `---` line"#]],
        );
    }
}
