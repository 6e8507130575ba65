//! Rules for the tests of the formats.

use scl_topology::diagnostic::{Rule, Severity};

/// An error.
pub(super) const ERROR: Rule = rule("SCL0999", Severity::Error);

/// A warning.
pub(super) const WARNING: Rule = rule("SCL0999", Severity::Warning);

/// Another error.
pub(super) const OTHER: Rule = rule("SCL0100", Severity::Error);

const fn rule(code: &'static str, severity: Severity) -> Rule {
    Rule { code, severity, title: "", explanation: "", example: "" }
}
