//! Message types: the Rust path of a type such as `rover.Measurement` in the file.

#[cfg(feature = "protobuf")]
mod rust_paths;

use super::names::identifier;
use proc_macro2::{Span, TokenStream};
use quote::quote;
use scl_loader::Loaded;
use std::collections::HashMap;

/// How the file's message types are named in Rust.
pub(super) enum MessageTypes {
    /// The file has no `schemas:`. The dotted name is the path, resolved where the macro is invoked.
    Written,
    /// From the compiled schemas: full protobuf name to path segments.
    #[cfg_attr(not(feature = "protobuf"), allow(dead_code))]
    Generated(HashMap<String, Vec<String>>),
    /// The schemas did not compile, so no type is known.
    Unknown,
}

impl MessageTypes {
    /// The message types of a loaded file.
    pub(super) fn of(loaded: &Loaded) -> Self {
        match &loaded.schemas {
            #[cfg(feature = "protobuf")]
            Some(schemas) => Self::Generated(rust_paths::rust_paths(schemas)),
            _ if loaded.model.schemas.is_empty() => Self::Written,
            _ => Self::Unknown,
        }
    }

    /// The path of a type, or `None` if Rust cannot name it.
    pub(super) fn path(&self, dotted: &str, span: Span) -> Option<TokenStream> {
        let segments: Vec<&str> = match self {
            Self::Written => dotted.split('.').map(str::trim).collect(),
            Self::Generated(paths) => paths.get(dotted)?.iter().map(String::as_str).collect(),
            Self::Unknown => return None,
        };
        let segments: Vec<_> = segments.into_iter().map(|name| segment(name, span)).collect::<Option<_>>()?;
        Some(quote!(#(#segments)::*))
    }

    /// The path as messages show it: `rover::Measurement`.
    pub(super) fn shown(&self, dotted: &str) -> String {
        match self {
            Self::Generated(paths) => {
                paths.get(dotted).map_or_else(|| dotted.replace('.', "::"), |path| path.join("::"))
            }
            _ => dotted.replace('.', "::"),
        }
    }
}

/// `crate`, `self` and `super` are not identifiers, but a path may start with them.
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
