//! The words for a schema that does not compile, at its own line, with the line of the topology file as second place.

use super::disk::SchemaFile;
use super::place::shown_beside;
use crate::request::Request;
use miette::Diagnostic as _;
use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::SCHEMA;
use scl_topology::source::{Sources, Span, Spanned};

/// One problem of one schema file.
pub(super) fn diagnose(
    error: &protox::Error,
    schema: &Spanned<String>,
    files: &[SchemaFile],
    request: &Request,
    sources: &mut Sources,
) -> Diagnostic {
    let wrong = in_backticks(&error.to_string());
    let message = format!("the schema file `{}` does not compile: {wrong}", error.file().unwrap_or(&schema.value));
    let mut problem = match place(error, files, request, sources) {
        Some((span, label)) => SCHEMA.at(message, span, label).label(schema.span, "compiled because of this line"),
        None => SCHEMA.at(message, schema.span, "named here"),
    };
    if let Some(help) = error.help() {
        problem = problem.help(in_backticks(&help.to_string()));
    }
    problem
}

/// Where in the schema it is, with the compiler's own word on it; adds the schema's text to the sources.
fn place(
    error: &protox::Error,
    files: &[SchemaFile],
    request: &Request,
    sources: &mut Sources,
) -> Option<(Span, String)> {
    let file = files.iter().find(|file| Some(file.name.as_str()) == error.file())?;
    let found = error.labels()?.next();
    let (start, length) = found.as_ref().map_or((file.text.len(), 0), |label| (label.offset(), label.len()));
    let end = start.saturating_add(length).min(file.text.len());
    let id = sources.add(shown_beside(&request.shown_as, &file.name), file.text.clone());
    let span = Span { file: id, start: start.min(end) as u32, end: end as u32 };
    Some((span, found.and_then(|label| label.label().map(in_backticks)).unwrap_or_default()))
}

/// The compiler quotes names with apostrophes, SCL with backticks.
fn in_backticks(text: &str) -> String {
    if text.matches('\'').count().is_multiple_of(2) { text.replace('\'', "`") } else { text.to_owned() }
}
