//! Identifiers for the names in the file.

use proc_macro2::Span;
use quote::format_ident;
use scl_topology::rust_name::{component_type, is_keyword};
use scl_topology::topology::{Component, ComponentType, Gate};
use syn::Ident;

/// An identifier, raw if the name is a keyword; `None` if the name cannot be an identifier.
pub(super) fn identifier(name: &str, span: Span) -> Option<Ident> {
    // The list is SCL's own, because syn does not know the keywords of newer editions.
    if is_keyword(name) {
        return Some(Ident::new_raw(name, span));
    }
    let mut ident = syn::parse_str::<Ident>(name).ok()?;
    ident.set_span(span);
    Some(ident)
}

/// The struct of a component, or of a kind.
pub(super) fn struct_name(component: ComponentType<'_>) -> Ident {
    checked(component.rust_name())
}

/// The enum of the components of a kind: `MotorInstance`.
pub(super) fn instance_name(kind: &str) -> Ident {
    format_ident!("{}Instance", checked(&component_type(kind)))
}

/// The variant of a component of a kind.
pub(super) fn variant_name(component: &Component) -> Ident {
    checked(component.rust_name())
}

/// The struct of its counterpart in unit tests: `ControllerPeer`.
pub(super) fn counterpart_name(component: ComponentType<'_>) -> Ident {
    format_ident!("{}Peer", struct_name(component))
}

/// The field of a gate.
pub(super) fn field_name(gate: &Gate) -> Ident {
    checked(gate.rust_name())
}

/// The identifier of a name that the checks have accepted.
pub(super) fn checked(name: &str) -> Ident {
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
            ("gen", Some("r#gen")),
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
