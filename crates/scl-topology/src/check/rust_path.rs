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
        let rust = types.into_iter().filter(|name| !name.in_schemas());
        let found: Vec<Diagnostic> = rust.filter_map(|name| diagnose(name, facts.messages.is_some())).collect();
        if !found.is_empty() {
            problems.extend(found);
            gate.payload = None;
        }
    }
}

fn diagnose(name: &TypeName, has_schemas: bool) -> Option<Diagnostic> {
    let dotted = name.dotted();
    if let Some((_, rust)) = SCALARS.iter().find(|(word, _)| *word == dotted) {
        let headline = format!("`{dotted}` is not a type of Rust or of the `schemas`");
        let found = NO_TYPE_NAME.at(headline, name.span(), "a type of another language");
        let found = match rust.is_empty() || has_schemas {
            true => {
                found.helps(is_bytes(dotted).then_some("a gate without a type carries bytes: nothing after the colon"))
            }
            false => found.did_you_mean(dotted, &[rust]),
        };
        return Some(
            found.help("a type is a message of the `schemas`, or a Rust path such as `crate.` and the type's name"),
        );
    }
    let (word, why) = unusable_part(dotted)?;
    let headline = format!("`{dotted}` cannot be a message type: Rust cannot name it");
    Some(NO_TYPE_NAME.at(headline, name.span(), format!("`{word}` {why}")).help("a type is the path of a Rust type"))
}

/// Scalars and other types of no shape in other languages, with the Rust types that correspond to them.
const SCALARS: [(&str, &str); 46] = [
    ("double", "f64"),
    ("float", "f32"),
    ("float32", "f32"),
    ("float64", "f64"),
    ("int", "i32"),
    ("long", "i64"),
    ("int8", "i8"),
    ("int16", "i16"),
    ("int32", "i32"),
    ("int64", "i64"),
    ("uint", "u32"),
    ("uint8", "u8"),
    ("uint16", "u16"),
    ("uint32", "u32"),
    ("uint64", "u64"),
    ("int8_t", "i8"),
    ("int16_t", "i16"),
    ("int32_t", "i32"),
    ("int64_t", "i64"),
    ("uint8_t", "u8"),
    ("uint16_t", "u16"),
    ("uint32_t", "u32"),
    ("uint64_t", "u64"),
    ("byte", "u8"),
    ("string", "String"),
    ("str", "String"),
    ("boolean", "bool"),
    ("Any", ""),
    ("any", ""),
    ("object", ""),
    ("number", ""),
    ("list", ""),
    ("dict", ""),
    ("bytes", ""),
    ("bytearray", ""),
    ("real", "f32"),
    ("lreal", "f64"),
    ("usint", "u8"),
    ("sint", "i8"),
    ("udint", "u32"),
    ("dint", "i32"),
    ("word", "u16"),
    ("dword", "u32"),
    ("decimal", ""),
    ("integer", "i32"),
    ("void", ""),
];

/// Whether a word is a scalar of another language.
pub(super) fn is_scalar(word: &str) -> bool {
    SCALARS.iter().any(|(other, _)| *other == word)
}

/// Whether a word means bytes of any meaning.
pub(super) fn is_bytes(word: &str) -> bool {
    matches!(word, "bytes" | "bytearray")
}

/// Whether a word in small letters is a type of Rust, which every file has in scope.
pub(super) fn is_rust(word: &str) -> bool {
    const TYPES: &str = "bool char f32 f64 i8 i16 i32 i64 i128 isize u8 u16 u32 u64 u128 usize";
    TYPES.split(' ').any(|other| other == word)
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
        let expected =
            "SCL0403 `nav.fn` cannot be a message type: Rust cannot name it [a type is the path of a Rust type]";
        assert_eq!(advice(yaml), expected);
        // A message of a schema gets another name in Rust.
        let yaml = format!("schemas: [nav.proto]\n{yaml}");
        let (found, _) = problems(&yaml, Some(&["nav.fn"]));
        assert!(found.iter().all(|found| found.code() != "SCL0403"));
    }
}
