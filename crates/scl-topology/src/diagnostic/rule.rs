//! One rule of the checker: its code, severity, explanation and example. Only a rule makes a
//! [`Diagnostic`](super::Diagnostic).

use std::hash::{Hash, Hasher};

/// How bad a problem is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The file cannot be used.
    Error,
    /// The file can be used, but is probably not what was meant.
    Warning,
    /// Off by default.
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
    /// A topology with the mistake and its correction, as the lines of a diff: `-` begins a line with the mistake, `+`
    /// a corrected one, and a space a line of both. Rules about Rust code show Rust. Empty if no example is short.
    pub example: &'static str,
}

impl Rule {
    /// The example with the mistake.
    pub fn bad_example(&self) -> String {
        self.example_without('+')
    }

    /// The example corrected.
    pub fn good_example(&self) -> String {
        self.example_without('-')
    }

    fn example_without(&self, other: char) -> String {
        let lines = self.example.split_inclusive('\n').filter(|line| !line.starts_with(other));
        lines.filter_map(|line| line.get(1..)).collect()
    }

    /// Returns true if there is an example and it is a topology. The examples of the families SCL00 (calls of the
    /// macro) and SCL10 (code that uses gates) are Rust.
    pub fn has_topology(&self) -> bool {
        !(self.example.is_empty() || self.code.starts_with("SCL00") || self.code.starts_with("SCL10"))
    }
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
