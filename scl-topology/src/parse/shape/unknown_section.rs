//! SCL0202: an unknown key at the top level.

use super::{suggest, ticked};
use crate::diagnostic::Diagnostic;
use crate::parse::fields::Field;
use crate::parse::sections::SECTIONS;

pub(in crate::parse) fn diagnose(field: Field<'_>) -> Diagnostic {
    let message = format!("unknown section `{}`", field.key);
    let problem = Diagnostic::error("SCL0202", message, field.key_span, "not a section of a topology");
    suggest(problem, "section", field.key, SECTIONS)
        .note(format!("sections: {}", ticked(SECTIONS)))
        .note("keys that start with `x-` are ignored, for your own use")
}
