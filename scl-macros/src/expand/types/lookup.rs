//! Which types of a file need a lookup: their path may name nothing, as [`found_types`](super::super::found_types)
//! explains.

use super::path;
use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote_spanned};
use scl_topology::topology::TypeName;
use std::collections::{BTreeSet, HashMap};
use syn::Ident;

/// Names that every program has.
const PRELUDE: [&str; 22] = [
    "bool", "char", "str", "f32", "f64", "i8", "i16", "i32", "i64", "i128", "isize", "u8", "u16", "u32", "u64", "u128",
    "usize", "String", "Vec", "Option", "Result", "Box",
];

/// The types of one file that are looked up.
pub(in crate::expand) struct Lookups {
    pub(in crate::expand) private: TokenStream,
    /// The struct that has the associated types.
    pub(in crate::expand) holder: Ident,
    /// The stand-in for a type that is not found.
    pub(in crate::expand) not_found: Ident,
    pub(in crate::expand) all: Vec<Lookup>,
    pub(in crate::expand) index: HashMap<String, usize>,
}

pub(in crate::expand) struct Lookup {
    pub(in crate::expand) dotted: String,
    pub(in crate::expand) starts_with: Start,
}

/// What the first part of a path names.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::expand) enum Start {
    /// A crate that the program depends on, or `crate`, `self` or `super`.
    Known,
    /// Something in scope, or nothing.
    Scope,
}

impl Lookups {
    /// `file` is the file's path as part of an identifier, `crates` the crates that the program can name, if they are
    /// known.
    pub(in crate::expand) fn new(
        file: &str,
        private: &TokenStream,
        crates: Option<&BTreeSet<String>>,
        dotted: BTreeSet<String>,
    ) -> Self {
        let mut lookups = Self {
            private: private.clone(),
            holder: format_ident!("__scl_types_{file}"),
            not_found: format_ident!("__scl_type_not_found_{file}"),
            all: Vec::new(),
            index: HashMap::new(),
        };
        let Some(crates) = crates else { return lookups };
        for dotted in dotted.into_iter().filter(|dotted| path(dotted.split('.'), Span::call_site()).is_some()) {
            let Some(starts_with) = start(&dotted, crates) else { continue };
            lookups.index.insert(dotted.clone(), lookups.all.len());
            lookups.all.push(Lookup { dotted, starts_with });
        }
        lookups
    }

    /// The type in Rust, or `None` if Rust cannot name it.
    pub(super) fn path(&self, dotted: &str, span: Span) -> Option<TokenStream> {
        let Some(&index) = self.index.get(dotted) else { return path(dotted.split('.'), span) };
        let Self { private, holder, .. } = self;
        Some(quote_spanned!(span => <#holder as #private::NamedType<#index>>::Type))
    }

    /// The stand-in for this type, if it may not be found.
    pub(in crate::expand) fn stand_in(&self, name: &TypeName) -> Option<&Ident> {
        self.index.contains_key(name.dotted()).then_some(&self.not_found)
    }
}

/// Returns what a path starts with; `None` if the type needs no lookup.
fn start(dotted: &str, crates: &BTreeSet<String>) -> Option<Start> {
    match dotted.split_once('.') {
        None if PRELUDE.contains(&dotted) => None,
        None => Some(Start::Scope),
        Some(("std" | "core", _)) => None,
        Some(("crate" | "self" | "super", _)) => Some(Start::Known),
        Some((first, _)) if crates.contains(first) => Some(Start::Known),
        Some(_) => Some(Start::Scope),
    }
}
