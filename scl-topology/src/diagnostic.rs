//! What the checker has to say: one [`Diagnostic`] a problem, gathered in [`Diagnostics`].

mod cargo;
mod json;
mod limit;
mod render;
mod sarif;
#[cfg(test)]
mod testing;

use crate::rule::Rule;
use crate::source::Span;

pub use crate::rule::Severity;
pub use cargo::{CargoUnit, cargo_end, cargo_start, to_cargo};
pub use json::to_json;
pub(crate) use limit::RULE as TOO_MANY;
pub use limit::{MOST_SHOWN, limit};
pub use render::{render, render_headless, render_styled};
pub use sarif::{CheckedFile, to_sarif};

/// A place with a word on it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What to see there; may be empty.
    pub text: String,
}

/// One problem: what is wrong, where, and the way out. Made by [`Rule::at`] and [`Rule::without_place`] only.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// The rule that found it.
    pub rule: &'static Rule,
    /// How bad it is: the rule's severity, unless a comment in the file or an option of a tool changed it.
    pub severity: Severity,
    /// The headline: lower case, no full stop, names in backticks.
    pub message: String,
    /// Why here. `None` only where no source text exists (the file is missing).
    pub primary: Option<Label>,
    /// The declarations involved.
    pub secondary: Vec<Label>,
    /// What to write instead, one way a line; a help may hold several lines.
    pub helps: Vec<String>,
    /// The rule, or the valid names.
    pub notes: Vec<String>,
}

impl Rule {
    /// A problem of this kind: its headline, its place and what to see there.
    pub fn at(&'static self, message: impl Into<String>, at: Span, label: impl Into<String>) -> Diagnostic {
        Diagnostic { primary: Some(Label { span: at, text: label.into() }), ..self.without_place(message) }
    }

    /// A problem of this kind that has no place in any text, for example because the file is missing.
    pub fn without_place(&'static self, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            rule: self,
            severity: self.severity,
            message: message.into(),
            primary: None,
            secondary: Vec::new(),
            helps: Vec::new(),
            notes: Vec::new(),
        }
    }
}

impl Diagnostic {
    /// The rule's code, for example `SCL0502`.
    pub fn code(&self) -> &'static str {
        self.rule.code
    }

    /// Adds another place.
    pub fn label(mut self, span: Span, text: impl Into<String>) -> Self {
        self.secondary.push(Label { span, text: text.into() });
        self
    }

    /// Adds a way out.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.helps.push(text.into());
        self
    }

    /// Adds the rule behind it.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }
}

/// The collector. Stages push into it and go on; whoever made it must read it.
///
/// # Panics
///
/// In debug builds, dropping one with problems in it panics, unless the thread does so already: whoever makes a
/// collector has to end with [`Diagnostics::into_sorted`], or hand its problems over with [`Diagnostics::append`].
#[derive(Debug, Default)]
pub struct Diagnostics {
    items: Vec<Diagnostic>,
}

impl Diagnostics {
    /// Nothing found yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a problem.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.items.push(diagnostic);
    }

    /// Adds several problems.
    pub fn extend(&mut self, diagnostics: impl IntoIterator<Item = Diagnostic>) {
        self.items.extend(diagnostics);
    }

    /// Takes all problems of another collector over.
    pub fn append(&mut self, mut other: Diagnostics) {
        self.items.append(&mut other.items);
    }

    /// Lets every problem be looked at and changed; those for which `keep` is false are taken out.
    pub(crate) fn retain(&mut self, keep: impl FnMut(&mut Diagnostic) -> bool) {
        self.items.retain_mut(keep);
    }

    /// Says that nobody needs these.
    pub(crate) fn discard(mut self) {
        self.items.clear();
    }

    /// Whether an error is among them.
    pub fn has_errors(&self) -> bool {
        self.items.iter().any(|item| item.severity == Severity::Error)
    }

    /// All of them, sorted by position; those without a place come first.
    pub fn into_sorted(mut self) -> Vec<Diagnostic> {
        let mut items = std::mem::take(&mut self.items);
        items.sort_by_key(|item| item.primary.as_ref().map(|label| (label.span, item.code())));
        items
    }
}

impl Drop for Diagnostics {
    fn drop(&mut self) {
        let is_read = self.items.is_empty() || std::thread::panicking();
        debug_assert!(is_read, "problems were found and nobody read them: {:?}", self.items);
    }
}

#[cfg(test)]
mod tests {
    use super::Diagnostics;
    use crate::external::FILE_NOT_FOUND;

    #[test]
    #[should_panic(expected = "nobody read them")]
    fn forgotten_problems_are_a_bug() {
        let mut problems = Diagnostics::new();
        problems.push(FILE_NOT_FOUND.without_place("no file"));
    }

    #[test]
    fn append_hands_problems_over() {
        let (mut all, mut some) = (Diagnostics::new(), Diagnostics::new());
        some.push(FILE_NOT_FOUND.without_place("no file"));
        all.append(some);
        assert!(all.has_errors());
        assert_eq!(all.into_sorted().len(), 1);
    }
}
