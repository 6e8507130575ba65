//! Modules for the messages of schemas that did not compile, so that rustc does not say that they do not exist.
//!
//! Each type is erroneous in a way that rustc has already reported, so using it causes no further errors.

use super::super::context::Context;
use super::super::names::identifier;
use super::super::problems::expand_unknown_type;
use super::super::types::written_types;
use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote};
use scl_loader::rust::names::{snake_case, upper_camel_case};
use std::collections::{BTreeMap, BTreeSet};

/// A module with its types.
#[derive(Default)]
struct Module {
    types: BTreeSet<String>,
    inner: BTreeMap<String, Module>,
}

/// The modules, if the file names schemas and they did not compile.
pub(in crate::expand) fn expand_unknown(context: &Context<'_>) -> TokenStream {
    let loaded = context.loaded;
    if loaded.schemas.is_some() || loaded.model.schemas.is_empty() {
        return TokenStream::new();
    }
    expand_stand_ins(context)
}

/// The modules as far as they are known: those that the schemas seem to declare, and those that gates name.
pub(super) fn expand_stand_ins(context: &Context<'_>) -> TokenStream {
    let loaded = context.loaded;
    let mut root = Module::default();
    for outline in &loaded.outlines {
        let package: Vec<&str> = outline.package.split('.').filter(|part| !part.is_empty()).collect();
        for path in &outline.types {
            root.declare(package.iter().copied().chain(path.iter().map(String::as_str)));
        }
    }
    // Gates may name types of a schema that could not even be read.
    for dotted in written_types(loaded).filter(|dotted| dotted.contains('.') && !starts_with_crate(context, dotted)) {
        root.declare(dotted.split('.'));
    }
    if context.for_editor {
        return expand_module(&root, 1, &|_| expand_unknown_type(context));
    }
    // The `Target` of an erroneous type, which does not implement `Deref`: rustc accepts even struct literals of it.
    let unknown = expand_unknown_type(context);
    let modules = expand_module(&root, 1, &|depth| {
        let supers = std::iter::repeat_n(quote!(super::), depth);
        quote!(<#(#supers)* #unknown as ::core::ops::Deref>::Target)
    });
    // A glob import is shadowed by the user's own module or type of the same name.
    let hidden = format_ident!("__scl_unknown_messages_{}", context.path_as_identifier());
    quote! {
        #[doc(hidden)]
        #[allow(warnings, missing_docs, clippy::all, clippy::pedantic)]
        mod #hidden { #modules }
        #[allow(unused_imports)]
        pub use #hidden::*;
    }
}

fn starts_with_crate(context: &Context<'_>, dotted: &str) -> bool {
    let first = dotted.split('.').next().unwrap_or_default();
    matches!(first, "crate" | "self" | "super" | "std" | "core") || context.is_extern_crate(first)
}

impl Module {
    /// Adds a type; the names before its own become modules, as prost makes them of packages and outer messages.
    fn declare<'a>(&mut self, path: impl IntoIterator<Item = &'a str>) {
        let path: Vec<&str> = path.into_iter().collect();
        if let Some((last, before)) = path.split_last() {
            let module = before.iter().fold(self, |it, name| it.inner.entry(snake_case(name)).or_default());
            module.types.insert(upper_camel_case(last));
        }
    }
}

/// Expands a module. `unknown` returns the type that all its types stand for, by the number of enclosing modules.
fn expand_module(module: &Module, depth: usize, unknown: &dyn Fn(usize) -> TokenStream) -> TokenStream {
    let types = module.types.iter().filter_map(|name| {
        let (name, unknown) = (identifier(name, Span::call_site())?, unknown(depth));
        Some(quote!(pub type #name = #unknown;))
    });
    let inner = module.inner.iter().filter_map(|(name, inner)| {
        let (name, inner) = (identifier(name, Span::call_site())?, expand_module(inner, depth + 1, unknown));
        Some(quote!(pub mod #name { #inner }))
    });
    quote!(#(#types)* #(#inner)*)
}
