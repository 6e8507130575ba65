//! `--deny`: warnings that count as errors.

use crate::explain::full_code;
use scl_topology::catalogue::find;
use scl_topology::diagnostic::{Diagnostic, Severity};

/// Which diagnostics count as errors.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Deny {
    /// Every warning; lints stay what they are.
    Warnings,
    /// Warnings and lints with this code.
    Code(String),
}

/// Reads `warnings` or a code.
///
/// # Errors
///
/// A text for the user if it is neither.
pub(super) fn parse_deny(text: &str) -> Result<Deny, String> {
    let code = full_code(text);
    match find(&code) {
        _ if text == "warnings" => Ok(Deny::Warnings),
        Some(_) => Ok(Deny::Code(code)),
        None => Err("expected `warnings` or a code like `SCL0402`; `scl explain` lists them".to_owned()),
    }
}

/// Turns a denied diagnostic into an error, and adds a note that says why.
pub(super) fn deny(mut diagnostic: Diagnostic, denied: &[Deny]) -> Diagnostic {
    let reason = denied.iter().find_map(|deny| match deny {
        Deny::Warnings if diagnostic.severity == Severity::Warning => Some("warnings"),
        Deny::Code(code) if diagnostic.severity != Severity::Error && code == diagnostic.code() => Some(code.as_str()),
        _ => None,
    });
    if let Some(reason) = reason {
        diagnostic.severity = Severity::Error;
        diagnostic.notes.push(format!("an error because of `--deny {reason}`"));
    }
    diagnostic
}

#[cfg(test)]
mod tests {
    use super::{Deny, parse_deny};

    #[test]
    fn codes_and_the_word_are_understood() {
        let code = |text: &str| Some(Deny::Code(text.to_owned()));
        for (text, expected) in [
            ("warnings", Some(Deny::Warnings)),
            ("SCL0402", code("SCL0402")),
            ("scl0402", code("SCL0402")),
            ("warning", None),
            ("SCL402", None),
            ("SCL9999", None),
            ("SCL04O2", None),
            ("", None),
        ] {
            assert_eq!(parse_deny(text).ok(), expected, "{text}");
        }
    }
}
