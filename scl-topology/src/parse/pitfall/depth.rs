//! SCL0116: nested too deeply.

use crate::diagnostic::Diagnostic;
use crate::source::Span;
use crate::yaml::MAX_DEPTH;

pub(super) fn diagnose(at: Span) -> Diagnostic {
    let message = format!("the file is nested more than {MAX_DEPTH} levels deep here");
    Diagnostic::error("SCL0116", message, at, format!("level {}", MAX_DEPTH + 1))
        .note("a topology needs 6 levels; the limit keeps the compiler from overflowing its stack")
}
