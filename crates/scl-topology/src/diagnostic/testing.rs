//! Rules for the tests of the renderer.

use super::{Rule, Severity};

/// An error.
pub(super) const ERROR: Rule = rule("SCL0999", Severity::Error);

/// A warning.
pub(super) const WARNING: Rule = rule("SCL0999", Severity::Warning);

const fn rule(code: &'static str, severity: Severity) -> Rule {
    Rule { code, severity, title: "", explanation: "", example: "" }
}
