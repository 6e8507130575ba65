//! Message types: from `rover.Measurement` in the file to a path in Rust.

use super::names::identifier;
use proc_macro2::{Span, TokenStream};
use quote::quote;
use scl_loader::Loaded;
use std::collections::HashMap;

/// How the types of the file are called in Rust.
pub(super) enum MessageTypes {
    /// No `schemas:`: the dotted name is the path, looked up where the macro is called.
    Written,
    /// From the compiled schemas: full name to path segments.
    #[cfg_attr(not(feature = "protobuf"), allow(dead_code))]
    Generated(HashMap<String, Vec<String>>),
    /// The schemas did not compile, so no type is known.
    Unknown,
}

impl MessageTypes {
    /// Those of a loaded file.
    pub(super) fn of(loaded: &Loaded) -> Self {
        match &loaded.schemas {
            #[cfg(feature = "protobuf")]
            Some(schemas) => Self::Generated(super::schemas::rust_paths(schemas)),
            _ if loaded.model.schemas.is_empty() => Self::Written,
            _ => Self::Unknown,
        }
    }

    /// The path of a type, or `None` if there can be none of this name.
    pub(super) fn path(&self, dotted: &str, span: Span) -> Option<TokenStream> {
        let segments: Vec<&str> = match self {
            Self::Written => dotted.split('.').map(str::trim).collect(),
            Self::Generated(paths) => paths.get(dotted)?.iter().map(String::as_str).collect(),
            Self::Unknown => return None,
        };
        let segments: Vec<_> = segments.into_iter().map(|name| segment(name, span)).collect::<Option<_>>()?;
        Some(quote!(#(#segments)::*))
    }

    /// The path as messages write it: `rover::Measurement`.
    pub(super) fn shown(&self, dotted: &str) -> String {
        match self {
            Self::Generated(paths) => {
                paths.get(dotted).map_or_else(|| dotted.replace('.', "::"), |path| path.join("::"))
            }
            _ => dotted.replace('.', "::"),
        }
    }
}

/// `crate`, `self` and `super` may start a path, so they are no names but segments.
fn segment(name: &str, span: Span) -> Option<syn::Ident> {
    match name {
        "crate" | "self" | "super" => Some(syn::Ident::new(name, span)),
        _ => identifier(name, span),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dotted_names_become_paths() {
        let cases = [
            ("Pose", Some("Pose")),
            ("rover.Pose", Some("rover :: Pose")),
            ("a.type.B", Some("a :: r#type :: B")),
            ("a..B", None),
            ("", None),
        ];
        for (dotted, expected) in cases {
            let path = MessageTypes::Written.path(dotted, Span::call_site()).map(|path| path.to_string());
            assert_eq!(path.as_deref(), expected, "{dotted:?}");
        }
    }
}
