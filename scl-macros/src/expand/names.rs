//! Names of the file become identifiers.

use proc_macro2::Span;
use syn::Ident;

/// An identifier, raw where it is a keyword; `None` if it cannot be one.
pub(super) fn identifier(name: &str, span: Span) -> Option<Ident> {
    let unescapable = matches!(name, "" | "_" | "self" | "Self" | "super" | "crate");
    if let Ok(mut ident) = syn::parse_str::<Ident>(name) {
        ident.set_span(span);
        return Some(ident);
    }
    // Only a keyword fails to parse as an identifier and succeeds with `r#`.
    (!unescapable && syn::parse_str::<Ident>(&format!("r#{name}")).is_ok()).then(|| Ident::new_raw(name, span))
}

/// The identifier of a name that the checks have accepted.
pub(super) fn checked(name: &str, span: Span) -> Ident {
    // The checks refuse every name that is no identifier; should one slip through, it shows instead of panicking.
    identifier(name, span).unwrap_or_else(|| Ident::new("name_that_is_no_identifier", span))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_become_raw_and_nonsense_nothing() {
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
