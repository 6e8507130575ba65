//! What the checker reports: one [`Diagnostic`] for each problem, collected in [`Diagnostics`].

mod help;
mod limit;
mod list_edit;
mod render;
mod rule;
#[cfg(test)]
mod testing;
mod told;

use crate::source::Span;
use std::borrow::Cow;

pub use help::{Edit, Help, Proposal, removal};
pub use limit::{MOST_LISTED, MOST_SHOWN, limit};
pub(crate) use limit::{RULE as TOO_MANY, first};
pub use list_edit::{appended, new_list, separator};
pub use render::{render, render_headless, render_styled};
pub use rule::{Rule, Severity};
pub use told::Told;

/// A place with a short text about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// The text shown at the place; may be empty.
    pub text: String,
}

/// One problem: what is wrong, where, and how to fix it. Made by [`Rule::at`] and [`Rule::without_place`] only.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// The rule that found it.
    pub rule: &'static Rule,
    /// How bad it is: the rule's severity, unless a comment in the file or an option of a tool changed it.
    pub severity: Severity,
    /// The headline: lower case, no full stop, names in backticks.
    pub message: String,
    /// The place of the problem. `None` only if no source text exists, for example because the file is missing.
    pub primary: Option<Label>,
    /// Other places involved, for example declarations: the first [`MOST_LABELS`].
    pub secondary: Vec<Label>,
    /// Number of further places that are not in `secondary`.
    pub unlisted: usize,
    /// What to write instead: each help is one way to do so; see [`shown_helps`](Self::shown_helps).
    pub(crate) helps: Vec<Help>,
    /// The rule, or the valid names.
    pub notes: Vec<String>,
    /// The name that the problem is about, if all problems of its rule about this name are one mistake.
    pub(crate) subject: Option<String>,
}

/// Maximum number of secondary labels of a diagnostic. Nobody reads more, and a hostile file must not decide how much
/// is kept and printed.
pub const MOST_LABELS: usize = 16;

/// Maximum length of one text of a diagnostic, in bytes: names in it may be as long as the file.
const LONGEST_TEXT: usize = 1_000;

impl Rule {
    /// Creates a problem of this rule from its headline, its place and the text shown there.
    pub fn at(&'static self, message: impl Into<String>, at: Span, label: impl Into<String>) -> Diagnostic {
        Diagnostic { primary: Some(Label { span: at, text: clipped(label) }), ..self.without_place(message) }
    }

    /// Creates a problem of this rule that has no place in any text, for example because the file is missing.
    pub fn without_place(&'static self, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            rule: self,
            severity: self.severity,
            message: clipped(message),
            primary: None,
            secondary: Vec::new(),
            unlisted: 0,
            helps: Vec::new(),
            notes: Vec::new(),
            subject: None,
        }
    }
}

impl Diagnostic {
    /// The rule's code, for example `SCL0502`.
    pub fn code(&self) -> &'static str {
        self.rule.code
    }

    /// Adds another place. After [`MOST_LABELS`] places, the further ones are only counted.
    pub fn label(mut self, span: Span, text: impl Into<String>) -> Self {
        self.add_label(span, text);
        self
    }

    /// Marks all problems of the rule about this name as one mistake.
    pub fn about(mut self, subject: impl Into<String>) -> Self {
        self.subject = Some(subject.into());
        self
    }

    /// Adds several places.
    pub fn labels<T: Into<String>>(mut self, labels: impl IntoIterator<Item = (Span, T)>) -> Self {
        labels.into_iter().for_each(|(span, text)| self.add_label(span, text));
        self
    }

    /// As [`label`](Self::label), for a diagnostic in place.
    pub fn add_label(&mut self, span: Span, text: impl Into<String>) {
        match self.secondary.len() < MOST_LABELS {
            true => self.secondary.push(Label { span, text: clipped(text) }),
            false => self.unlisted += 1,
        }
    }

    /// The notes, and one more if there are places that are not listed.
    pub fn all_notes(&self) -> impl Iterator<Item = Cow<'_, str>> {
        let rest = match self.unlisted {
            0 => None,
            1 => Some("1 more place is not shown".to_owned()),
            more => Some(format!("{more} more places are not shown")),
        };
        self.notes.iter().map(|note| Cow::from(note.as_str())).chain(rest.map(Cow::from))
    }

    /// Adds a note, for example the rule behind the problem.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(clipped(text));
        self
    }

    /// Adds notes: none, one or several.
    pub fn notes<T: Into<String>>(self, texts: impl IntoIterator<Item = T>) -> Self {
        texts.into_iter().fold(self, Self::note)
    }
}

/// The text, cut at [`LONGEST_TEXT`].
fn clipped(text: impl Into<String>) -> String {
    let mut text = text.into();
    if text.len() > LONGEST_TEXT {
        let end = (0..=LONGEST_TEXT).rev().find(|&end| text.is_char_boundary(end)).unwrap_or_default();
        text.truncate(end);
        text.push_str("...");
    }
    text
}

/// Collects problems. Stages push into it and continue; its creator must read it.
///
/// # Panics
///
/// In debug builds, dropping a collector with problems in it panics, unless the thread is panicking already: its
/// creator must end with [`Diagnostics::into_sorted`], or hand the problems over with [`Diagnostics::append`].
#[derive(Debug, Default)]
pub struct Diagnostics {
    items: Vec<Diagnostic>,
}

impl Diagnostics {
    /// Creates an empty collector.
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

    /// Moves all problems of another collector into this one.
    pub fn append(&mut self, mut other: Diagnostics) {
        self.items.append(&mut other.items);
    }

    /// Calls `keep` for every problem, which may change it, and removes those for which it returns false.
    pub fn retain(&mut self, keep: impl FnMut(&mut Diagnostic) -> bool) {
        self.items.retain_mut(keep);
    }

    /// Discards all problems, so that dropping the collector does not panic.
    pub(crate) fn discard(mut self) {
        self.items.clear();
    }

    /// Whether any of the problems is an error.
    pub fn has_errors(&self) -> bool {
        self.items.iter().any(|item| item.severity == Severity::Error)
    }

    /// Returns all problems, sorted by position, with errors first at the same position. Problems without a place come
    /// before all others.
    pub fn into_sorted(mut self) -> Vec<Diagnostic> {
        let mut items = std::mem::take(&mut self.items);
        items.sort_by_key(|item| {
            let span = item.primary.as_ref().map(|label| label.span);
            (span.map(|span| (span.file, span.start)), item.severity, span, item.code())
        });
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
    use super::{Diagnostics, LONGEST_TEXT, MOST_LABELS};
    use crate::external::{FILE_NOT_FOUND, FILE_TOO_LARGE, PATH_OF_ONE_MACHINE};
    use crate::source::{FileId, Span};

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

    #[test]
    fn errors_come_first_at_one_place() {
        let mut problems = Diagnostics::new();
        let span = |start, end| Span { file: FileId(0), start, end };
        for (rule, start, end) in [(&FILE_NOT_FOUND, 5, 9), (&PATH_OF_ONE_MACHINE, 5, 7), (&PATH_OF_ONE_MACHINE, 1, 2)]
        {
            problems.push(rule.at("", span(start, end), ""));
        }
        problems.push(FILE_TOO_LARGE.without_place(""));
        let codes: Vec<_> = problems.into_sorted().iter().map(|problem| problem.code()).collect();
        assert_eq!(codes, ["SCL0004", "SCL0006", "SCL0001", "SCL0006"]);
    }

    #[test]
    fn labels_and_texts_are_bounded() {
        let span = Span { file: FileId(0), start: 0, end: 1 };
        let mut problem = FILE_NOT_FOUND.at("ä".repeat(1_000), span, "").note("rule");
        for _ in 0..20_000 {
            problem.add_label(span, "here");
        }
        assert_eq!((problem.secondary.len(), problem.message.len()), (MOST_LABELS, LONGEST_TEXT + 3));
        assert_eq!(problem.all_notes().collect::<Vec<_>>(), ["rule", "19984 more places are not shown"]);
    }
}
