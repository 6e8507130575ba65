//! Text for `#[diagnostic::on_unimplemented]`.

use super::context::Context;
use proc_macro2::TokenStream;
use quote::quote;
use scl_topology::source::{Sources, Span};

/// The attribute with the error that rustc reports where a trait is not implemented. The message may contain the
/// trait's parameters in braces.
pub(crate) fn on_unimplemented(message: &str, label: &str, notes: &[String]) -> TokenStream {
    let (label, notes) = (escape_braces(label), notes.iter().map(|note| escape_braces(note)));
    quote!(#[diagnostic::on_unimplemented(message = #message, label = #label #(, note = #notes)*)])
}

/// A note that shows a line of the topology file below `heading`.
pub(super) fn note_with_excerpt(context: &Context<'_>, heading: &str, span: Span) -> String {
    format!("{heading}\n{}", excerpt(&context.loaded.sources, span))
}

/// Escapes the braces of a text, which rustc would read as format parameters.
pub(crate) fn escape_braces(text: &str) -> String {
    text.replace('{', "{{").replace('}', "}}")
}

/// `--> topology.yaml:4:9`, the line, and carets below the span, in rustc's layout.
fn excerpt(sources: &Sources, span: Span) -> String {
    let file = sources.file(span.file);
    let at = file.line_column(span.start);
    let start = file.text().get(..span.start as usize).and_then(|before| before.rfind('\n')).map_or(0, |end| end + 1);
    let line = file.text()[start..].lines().next().unwrap_or("").trim_end().replace('\t', "    ");
    let number = at.line.to_string();
    let margin = " ".repeat(number.len());
    let length = sources.snippet(span).lines().next().unwrap_or("").chars().count().max(1);
    let indent = " ".repeat(at.column as usize - 1);
    let carets = "^".repeat(length);
    format!("{margin}--> {}\n{margin} |\n{number} | {line}\n{margin} | {indent}{carets}", sources.place(span))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn carets_stand_below_the_span() {
        let mut sources = Sources::new();
        let file = sources.add("t.yaml", "a:\r\n  - measurements: pub\r\n");
        let drawn = excerpt(&sources, Span { file, start: 8, end: 20 });
        let expected = " --> t.yaml:2:5\n  |\n2 |   - measurements: pub\n  |     ^^^^^^^^^^^^";
        assert_eq!(drawn, expected);
    }
}
