//! One rule of the checker: its code, severity, explanation and examples. Only a rule makes a
//! [`Diagnostic`](crate::diagnostic::Diagnostic).

use std::hash::{Hash, Hasher};

/// How bad a problem is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The file cannot be used.
    Error,
    /// The file can be used, but is probably not what was meant.
    Warning,
    /// Off unless asked for.
    Lint,
}

/// One rule. Two rules are equal if they have the same code.
#[derive(Debug, Clone)]
pub struct Rule {
    /// For example `SCL0502`.
    pub code: &'static str,
    /// The severity of its diagnostics unless a comment in the file or an option changes it.
    pub severity: Severity,
    /// What is wrong, in a few words.
    pub title: &'static str,
    /// What it means, why it matters and how to fix it, in some sentences.
    pub explanation: &'static str,
    /// A file with the mistake, and one without.
    pub examples: Examples,
}

/// Texts that show a mistake and its correction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Examples {
    /// No example is possible, or none is short.
    None,
    /// Topology files.
    Topology {
        /// With the mistake.
        bad: &'static str,
        /// Corrected.
        good: &'static str,
    },
    /// Lines of Rust.
    Rust {
        /// With the mistake.
        bad: &'static str,
        /// Corrected.
        good: &'static str,
    },
}

impl PartialEq for Rule {
    fn eq(&self, other: &Self) -> bool {
        self.code == other.code
    }
}

impl Eq for Rule {}

impl Hash for Rule {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.code.hash(state);
    }
}
