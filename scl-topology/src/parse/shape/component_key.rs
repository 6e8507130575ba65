//! SCL0207: an unknown key in a component.

use super::{suggest, ticked};
use crate::diagnostic::Diagnostic;
use crate::parse::component::KEYS;
use crate::parse::fields::Field;

pub(in crate::parse) fn diagnose(field: Field<'_>, component: &str) -> Diagnostic {
    let message = format!("unknown key `{}` in component `{component}`", field.key);
    let problem = Diagnostic::error("SCL0207", message, field.key_span, "not a key of a component");
    suggest(problem, "key", field.key, KEYS).note(format!("keys of a component: {}", ticked(KEYS)))
}
