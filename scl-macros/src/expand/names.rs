//! Identifiers for the names in the file.

use proc_macro2::Span;
use quote::format_ident;
use scl_topology::topology::{Component, Gate};
use syn::Ident;

/// An identifier, raw if the name is a keyword; `None` if the name cannot be an identifier.
pub(super) fn identifier(name: &str, span: Span) -> Option<Ident> {
    let has_no_raw_form = matches!(name, "" | "_" | "self" | "Self" | "super" | "crate");
    if let Ok(mut ident) = syn::parse_str::<Ident>(name) {
        ident.set_span(span);
        return Some(ident);
    }
    // Only a keyword fails to parse as an identifier and succeeds with `r#`.
    (!has_no_raw_form && syn::parse_str::<Ident>(&format!("r#{name}")).is_ok()).then(|| Ident::new_raw(name, span))
}

/// The struct of a component.
pub(super) fn struct_name(component: &Component) -> Ident {
    checked(component.rust_name())
}

/// The struct of its counterpart in unit tests: `ControllerPeer`.
pub(super) fn counterpart_name(component: &Component) -> Ident {
    format_ident!("{}Peer", struct_name(component))
}

/// The field of a gate.
pub(super) fn field_name(gate: &Gate) -> Ident {
    checked(gate.rust_name())
}

/// The identifier of a name that the checks have accepted.
fn checked(name: &str) -> Ident {
    let span = Span::call_site();
    // The checks refuse every name that is not an identifier; if one slips through, rustc reports it without a panic.
    identifier(name, span).unwrap_or_else(|| Ident::new("name_that_is_not_an_identifier", span))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_become_raw_and_other_texts_nothing() {
        let cases = [
            ("sensor", Some("sensor")),
            ("type", Some("r#type")),
            ("gen", Some("gen")),
            ("self", None),
            ("crate", None),
            ("_", None),
            ("", None),
            ("a-b", None),
            ("1st", None),
            ("a b", None),
            ("r#type", Some("r#type")),
        ];
        for (name, expected) in cases {
            let found = identifier(name, Span::call_site()).map(|ident| ident.to_string());
            assert_eq!(found.as_deref(), expected, "{name:?}");
        }
    }
}
