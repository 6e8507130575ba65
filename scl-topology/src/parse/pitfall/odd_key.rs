//! SCL0120: a key that is no plain word.

use crate::diagnostic::Diagnostic;
use crate::yaml::Node;

pub(in crate::parse) fn diagnose(key: &Node) -> Diagnostic {
    let label = format!("this key is {}", crate::parse::shape_word(key));
    Diagnostic::error("SCL0120", "a key must be a plain word", key.span, label)
}
