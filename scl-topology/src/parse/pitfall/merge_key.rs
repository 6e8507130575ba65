//! SCL0112: the merge key `<<`.

use crate::diagnostic::Diagnostic;
use crate::yaml::Node;

pub(in crate::parse) fn diagnose(key: &Node) -> Diagnostic {
    let message = "the merge key `<<` is not supported";
    Diagnostic::error("SCL0112", message, key.span, "YAML 1.1 extension, not part of YAML 1.2")
        .help("write the keys out")
}
