//! Diagnostics for schemas that do not compile: at a line of the schema, with the line of the topology file as a second
//! place.

use super::disk::SchemaFile;
use super::explain::{Explained, explain};
use super::mistake::Mistake;
use super::place::Texts;
use miette::{Diagnostic as _, LabeledSpan};
use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::SCHEMA;
use scl_topology::source::Spanned;
use std::path::Path;

impl Texts<'_> {
    /// Returns the diagnostics of an entry: the mistakes in its files, or else the compiler's error. Mistakes in `told`
    /// were reported with an earlier entry and are left out; new ones are added to it.
    pub(super) fn what_is_wrong(
        &mut self,
        error: &protox::Error,
        mistakes: Vec<Mistake>,
        told: &mut Vec<Mistake>,
        schema: &Spanned<String>,
    ) -> Vec<Diagnostic> {
        if mistakes.is_empty() {
            return vec![self.error(error, schema)];
        }
        let is_new = |mistake: &Mistake| !mistake.follows && !told.contains(mistake);
        let new: Vec<Mistake> = mistakes.into_iter().filter(is_new).collect();
        let problems = new.iter().map(|mistake| self.mistake(mistake, schema)).collect();
        told.extend(new);
        problems
    }

    /// The compiler's error.
    fn error(&mut self, error: &protox::Error, schema: &Spanned<String>) -> Diagnostic {
        let wrong = in_backticks(&error.to_string());
        let file = self.files.iter().find(|file| Some(file.name.as_str()) == error.file());
        let shown = file.map(|file| self.folders.relative(&file.path).display().to_string());
        let name = shown.as_deref().or(error.file()).unwrap_or(&schema.value);
        let message = format!("the schema file `{name}` does not compile: {wrong}");
        let mut labels = error.labels().map(Iterator::collect::<Vec<_>>);
        // The compiler names the first of two declarations first; the second is more likely the wrong one.
        let is_first = |labels: &[LabeledSpan]| labels.first()?.label().map(|label| label.starts_with("first "));
        if let Some(labels) = labels.as_mut().filter(|labels| is_first(labels) == Some(true)) {
            labels.reverse();
        }
        let problem = match (file, labels) {
            (Some(file), Some(labels)) => {
                let text = |label: &LabeledSpan| label.label().map(in_backticks).unwrap_or_default();
                let at = labels.first().map_or((file.text.len(), 0), |label| (label.offset(), label.len()));
                let label = labels.first().map(text).unwrap_or_default();
                let others = labels.iter().skip(1).map(|label| {
                    (self.span(file, label.offset()..label.offset().saturating_add(label.len())), text(label))
                });
                let others: Vec<_> = others.collect();
                let span = self.span(file, at.0..at.0.saturating_add(at.1));
                let Explained { help, places } =
                    explain(&error.to_string(), &file.text, at.0, &file.path, self.folders);
                let places = places.into_iter().map(|place| (self.span(file, place), "and here")).collect::<Vec<_>>();
                SCHEMA.at(message, span, label).labels(others).labels(places).label(schema.span, BECAUSE).helps(help)
            }
            _ => SCHEMA.at(message, schema.span, "named here"),
        };
        problem.helps(error.help().map(|help| in_backticks(&help.to_string())))
    }

    /// One mistake in one schema file.
    fn mistake(&mut self, mistake: &Mistake, schema: &Spanned<String>) -> Diagnostic {
        let is_its_file = |file: &&SchemaFile| self.folders.relative(&file.path) == Path::new(&mistake.file);
        let problem = match self.files.iter().find(is_its_file) {
            Some(file) => {
                let span = self.span(file, mistake.at.clone());
                SCHEMA.at(&mistake.message, span, &mistake.label).label(schema.span, BECAUSE)
            }
            None => SCHEMA.at(&mistake.message, schema.span, "named here"),
        };
        let problem = match &mistake.root {
            Some(root) => self.folders.suggest_root(problem, root, self.sources),
            None => problem,
        };
        let problem = problem.helps(&mistake.help).notes(&mistake.note);
        match &mistake.subject {
            Some(subject) => problem.about(subject),
            None => problem,
        }
    }
}

const BECAUSE: &str = "compiled because of this line";

/// Replaces the apostrophes in which the compiler quotes names by backticks, unless their number is odd.
fn in_backticks(text: &str) -> String {
    if text.matches('\'').count().is_multiple_of(2) { text.replace('\'', "`") } else { text.to_owned() }
}
