//! Every check with its code, its explanation and its examples. `scl explain SCL0511` prints an entry, the table of the
//! documentation is made from it, and the tests hold each entry to what it says.

mod elsewhere;
mod page;
#[cfg(test)]
mod tests;

use crate::diagnostic::{Diagnostic, Label, Severity};
use crate::source::Span;
use crate::{check, diagnostic, parse};
use std::sync::LazyLock;

pub use page::{explain, page};

/// One check.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rule {
    /// For example `SCL0502`.
    pub code: &'static str,
    /// How bad it is, as long as no comment in the file says otherwise.
    pub severity: Severity,
    /// What is wrong, in a few words.
    pub title: &'static str,
    /// What it means, why it matters, how to mend it: some sentences.
    pub explanation: &'static str,
    /// A file with the mistake, and one without.
    pub examples: Examples,
}

/// Texts that show a check.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Examples {
    /// None are possible, or none are short.
    None,
    /// Topology files.
    Topology {
        /// With the mistake.
        bad: &'static str,
        /// Mended.
        good: &'static str,
    },
    /// Lines of Rust.
    Rust {
        /// With the mistake.
        bad: &'static str,
        /// Mended.
        good: &'static str,
    },
}

/// All checks, by their codes.
pub static ALL: LazyLock<Vec<&'static Rule>> = LazyLock::new(|| {
    let groups = [&parse::PITFALLS[..], &parse::SHAPES, &check::RULES, &[&diagnostic::TOO_MANY], &elsewhere::RULES];
    let mut all = groups.concat();
    all.sort_by_key(|rule| rule.code);
    all
});

/// The check of a code; upper or lower case.
pub fn find(code: &str) -> Option<&'static Rule> {
    ALL.iter().copied().find(|rule| rule.code.eq_ignore_ascii_case(code))
}

impl Rule {
    /// A problem of this kind, with its headline, its place and a word on the place.
    pub fn at(&self, message: impl Into<String>, at: Span, label: impl Into<String>) -> Diagnostic {
        Diagnostic { primary: Some(Label { span: at, text: label.into() }), ..self.fileless(message) }
    }

    /// A problem of this kind without a place in any text.
    pub fn fileless(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: self.severity, ..Diagnostic::fileless(self.code, message) }
    }
}
