//! SCL0403 for a path that is not valid in Rust. `schema_type` decides which types are Rust paths.

use super::Facts;
use super::draft::Draft;
use super::payload_type::NO_TYPE_NAME;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::rust_name::{is_keyword, is_unescapable};
use crate::topology::{Payload, TypeName};

pub(super) fn check(draft: &mut Draft<'_>, facts: &Facts, problems: &mut Diagnostics) {
    if facts.messages.is_none() && !draft.model.schemas.is_empty() {
        // The schemas are broken, so any type may be one of theirs.
        return;
    }
    for gate in &mut draft.gates {
        let types = gate.payload.as_ref().map(Payload::types).unwrap_or_default();
        let found: Vec<Diagnostic> = types.into_iter().filter(|name| !name.in_schemas()).filter_map(diagnose).collect();
        if !found.is_empty() {
            problems.extend(found);
            gate.payload = None;
        }
    }
}

fn diagnose(name: &TypeName) -> Option<Diagnostic> {
    let dotted = name.dotted();
    let (word, why) = unusable_part(dotted)?;
    let headline = format!("`{dotted}` cannot be a message type: Rust cannot name it");
    Some(NO_TYPE_NAME.at(headline, name.span(), format!("`{word}` {why}")).help("write the path of a type"))
}

/// The first part that cannot be where it is, and why. A path may start with `crate`, `self` or several `super`, and
/// modules may have the names of keywords (`r#type`).
fn unusable_part(dotted: &str) -> Option<(&str, &'static str)> {
    let parts: Vec<&str> = dotted.split('.').collect();
    let is_start = |at: usize| match parts[at] {
        "crate" | "self" => at == 0,
        "super" => parts[..at].iter().all(|part| matches!(*part, "super" | "self")),
        _ => false,
    };
    parts.iter().enumerate().find_map(|(at, &part)| {
        let is_last = at + 1 == parts.len();
        match part {
            _ if is_last && (is_keyword(part) || is_unescapable(part)) => {
                Some((part, "is a keyword of Rust, not a type"))
            }
            _ if is_unescapable(part) && !is_start(at) => Some((part, "is a keyword of Rust that cannot be a module")),
            _ => None,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::unusable_part;
    use crate::check::testing::{advice, problems};

    #[test]
    fn keywords_are_types_nowhere_and_modules_where_rust_can_escape_them() {
        let good =
            ["Fix", "nav.Fix", "crate.Fix", "self.a.Fix", "super.super.Fix", "self.super.Fix", "a.type.Fix", "union"];
        for dotted in good {
            assert_eq!(unusable_part(dotted), None, "{dotted}");
        }
        let bad =
            ["nav.fn", "fn", "Self", "crate", "nav.crate.Fix", "nav.self.Fix", "a.super.Fix", "nav.Self", "super"];
        for dotted in bad {
            assert!(unusable_part(dotted).is_some(), "{dotted}");
        }
    }

    #[test]
    fn a_type_that_rust_cannot_name_is_refused() {
        let yaml = "components:\n  - name: a\n    gates:\n      - x: {pub: nav.fn, unconnected: ok}\n";
        let expected = "SCL0403 `nav.fn` cannot be a message type: Rust cannot name it [write the path of a type]";
        assert_eq!(advice(yaml), expected);
        // A message of a schema gets another name in Rust.
        let yaml = format!("schemas: [nav.proto]\n{yaml}");
        let (found, _) = problems(&yaml, Some(&["nav.fn"]));
        assert!(found.iter().all(|found| found.code() != "SCL0403"));
    }
}
