//! `SCL02xx`: valid YAML that does not have the shape of a topology.

pub(super) mod ends;
pub(super) mod gate;
mod habit;
pub(super) mod level;
pub(super) mod long_gate;
pub(super) mod missing;
mod moved;
pub(super) mod nameless;
pub(super) mod nameless_gate;
pub(super) mod option_value;
pub(super) mod pairs;
mod ports;
mod reference;
pub(super) mod section_kind;
mod shift;
pub(super) mod stray_connection;
pub(super) mod top_level;
pub(super) mod unknown_key;
pub(super) mod version;

use crate::diagnostic::{Diagnostic, Rule};
use crate::grammar;

/// All of them, by their codes.
pub(crate) const RULES: &[&Rule] = &[
    &top_level::RULE,
    &unknown_key::SECTION,
    &missing::SECTION,
    &section_kind::RULE,
    &missing::COMPONENTS,
    &missing::CONNECTIONS,
    &unknown_key::OF_COMPONENT,
    &nameless::RULE,
    &missing::GATES,
    &gate::RULE,
    &ends::RULE,
    &unknown_key::OF_GATE,
    &version::RULE,
    &level::RULE,
    &option_value::RULE,
    &stray_connection::RULE,
];

/// Adds the place where a key of the user's own may stand, if it is one.
fn own_key(problem: Diagnostic, key: &str) -> Diagnostic {
    match key.starts_with(grammar::OWN_PREFIX) {
        true => problem.help("keys of your own, which start with `x-`, belong at the top of the file"),
        false => problem,
    }
}

#[cfg(test)]
mod tests;
