//! Corrections as data, for `scl check --fix` and for editors.

use super::Diagnostic;
use crate::source::Span;

/// One replacement of text that solves a problem, or a part of it.
///
/// The sure fixes of a diagnostic belong together and are applied together. Unsure ones are alternatives: editors offer
/// them, and no tool applies them by itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fix {
    /// What is replaced; an empty span inserts.
    pub span: Span,
    /// The new text; empty to remove the old one. Line breaks are `\n`, whatever the file has.
    pub replacement: String,
    /// Whether nothing else can have been meant.
    pub sure: bool,
}

impl Diagnostic {
    /// Adds a replacement that is certainly what was meant. `scl check --fix` applies it.
    pub fn fix(self, span: Span, replacement: impl Into<String>) -> Self {
        self.with_fix(span, replacement, true)
    }

    /// Adds a replacement that may have been meant. Editors offer it.
    pub fn maybe_fix(self, span: Span, replacement: impl Into<String>) -> Self {
        self.with_fix(span, replacement, false)
    }

    /// Adds replacements of one place: a single one is sure, several are alternatives.
    pub fn fix_if_single<S: AsRef<str>>(self, span: Span, replacements: &[S]) -> Self {
        let sure = replacements.len() == 1;
        replacements.iter().fold(self, |found, replacement| found.with_fix(span, replacement.as_ref(), sure))
    }

    fn with_fix(mut self, span: Span, replacement: impl Into<String>, sure: bool) -> Self {
        self.fixes.push(Fix { span, replacement: replacement.into(), sure });
        self
    }
}
