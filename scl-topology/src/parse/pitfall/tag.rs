//! SCL0113: a YAML tag.

use crate::diagnostic::Diagnostic;
use crate::source::Span;

pub(super) fn diagnose(tag: Span) -> Diagnostic {
    Diagnostic::error("SCL0113", "YAML tags are not supported in a topology", tag, "tag").help("remove the tag")
}
