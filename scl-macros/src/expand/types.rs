//! Message types: the Rust path of a type such as `rover.Measurement` in the file.

mod lookup;

pub(super) use lookup::{Lookup, Lookups, Start};

use super::names::identifier;
use proc_macro2::{Span, TokenStream};
use quote::quote;
use scl_loader::Loaded;
use scl_topology::topology::Payload;
use std::collections::{BTreeSet, HashMap};
use syn::Ident;

/// How the file's message types are named in Rust.
pub(super) struct MessageTypes {
    /// Full protobuf name to path segments; every other type is a Rust path. `None` if the schemas did not compile, so
    /// that it is not known which types are theirs.
    of_schemas: Option<HashMap<String, Vec<String>>>,
    of_rust: Lookups,
}

impl MessageTypes {
    /// The message types of a loaded file, as far as gates of the generated components use them.
    pub(super) fn of(
        loaded: &Loaded,
        includes: impl Fn(&str) -> bool,
        lookups: impl FnOnce(BTreeSet<String>) -> Lookups,
    ) -> Self {
        let of_schemas = match &loaded.schemas {
            #[cfg(feature = "protobuf")]
            Some(schemas) => Some(scl_loader::rust::rust_paths(schemas)),
            _ => loaded.model.schemas.is_empty().then(HashMap::new),
        };
        let mut named = named_types(loaded, includes);
        named.retain(|dotted| of_schemas.as_ref().is_some_and(|known| !known.contains_key(dotted)));
        Self { of_schemas, of_rust: lookups(named) }
    }

    /// The type in Rust, or `None` if Rust cannot name it.
    pub(super) fn path(&self, dotted: &str, span: Span) -> Option<TokenStream> {
        match self.of_schemas.as_ref()?.get(dotted) {
            Some(segments) => path(segments.iter().map(String::as_str), span),
            None => self.of_rust.path(dotted, span),
        }
    }

    /// The path as messages show it: `rover::Measurement`.
    pub(super) fn shown(&self, dotted: &str) -> String {
        let segments = self.of_schemas.as_ref().and_then(|known| known.get(dotted));
        segments.map_or_else(|| dotted.replace('.', "::"), |segments| segments.join("::"))
    }

    /// The full names of the messages of the schemas, sorted, with their paths. Those of the well-known types are left
    /// out, because prost has types for them.
    #[cfg(feature = "protobuf")]
    pub(super) fn of_schemas(&self, span: Span) -> Vec<(&str, TokenStream)> {
        let own = self.of_schemas.iter().flatten().filter(|(name, _)| !name.starts_with("google.protobuf."));
        let mut all: Vec<(&str, TokenStream)> = own
            .filter_map(|(name, segments)| Some((name.as_str(), path(segments.iter().map(String::as_str), span)?)))
            .collect();
        all.sort_by_key(|(name, _)| *name);
        all
    }

    /// The Rust paths that are looked up.
    pub(super) fn lookups(&self) -> &Lookups {
        &self.of_rust
    }
}

/// The types of the generated components, or all types in a file that is not a topology.
fn named_types(loaded: &Loaded, includes: impl Fn(&str) -> bool) -> BTreeSet<String> {
    if let Some(topology) = &loaded.topology {
        let included = topology.types().filter(|it| includes(it.name()));
        let payloads = included.flat_map(|it| it.component.gates()).map(|&id| topology.gate(id).payload());
        return payloads.flat_map(Payload::types).map(|name| name.dotted().to_owned()).collect();
    }
    written_types(loaded).map(str::to_owned).collect()
}

/// The types that gates name, as they are written.
pub(super) fn written_types(loaded: &Loaded) -> impl Iterator<Item = &str> {
    let gates = loaded.model.owners().flat_map(|owner| &owner.gates);
    let payloads = gates.filter_map(|gate| gate.payload.as_ref());
    payloads.flat_map(|payload| payload.value.split("->")).map(str::trim)
}

/// `a::b::C`, or `None` if a segment is not an identifier.
pub(super) fn path<'a>(segments: impl IntoIterator<Item = &'a str>, span: Span) -> Option<TokenStream> {
    let segments: Vec<Ident> = segments.into_iter().map(|name| segment(name, span)).collect::<Option<_>>()?;
    Some(quote!(#(#segments)::*))
}

/// `crate`, `self` and `super` are not identifiers, but a path may start with them.
pub(super) fn segment(name: &str, span: Span) -> Option<Ident> {
    match name {
        "crate" | "self" | "super" => Some(Ident::new(name, span)),
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
            let path = path(dotted.split('.'), Span::call_site()).map(|path| path.to_string());
            assert_eq!(path.as_deref(), expected, "{dotted:?}");
        }
    }
}
