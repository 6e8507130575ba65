//! Rust types that need to exist only where a component that uses them is opened.
//!
//! A path in a struct must resolve, or the program does not compile. A program that opens `gps` should not have to
//! depend on the crate of the camera's messages, though. Therefore each such type is the associated type of a hidden
//! trait, and its path stands inside a block where a stand-in has the same name:
//!
//! ```text
//! const _: () = {
//!     mod camera { pub type Image = super::NotFound; }      // the stand-in
//!     const _: () = {
//!         use self::*;                                       // a `camera` of the module hides the stand-in
//!         impl NamedType<0> for Types { type Type = camera::Image; }
//!     };
//! };
//! ```
//!
//! Names of the innermost block come first, then those of the outer block, then those of the module, then crates.
//! Therefore a path that starts with the name of a crate has a stand-in for its last part only, and imports what
//! precedes it. The methods that open a component require that none of its types is the stand-in, see
//! [`Requirements`].

use super::codec_type::codec_type;
use super::context::Context;
use super::problems::unknown_type_name;
use super::rustc_notes::{escape_braces, note_with_excerpt, on_unimplemented};
use super::types::{Lookup, Lookups, Start, path, segment};
use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use scl_text::list::quoted_list;
use scl_topology::external::TYPE_NOT_FOUND;
use scl_topology::topology::{Codec, Component, Payload, Topology, TypeName};
use std::collections::{BTreeMap, BTreeSet};
use syn::Ident;

/// Maximum number of gates that a report names; the rest are counted.
const MOST_GATES: usize = 3;

/// The lookups of all types. In a broken file, types that are not found become the unknown type, without an error.
pub(super) fn expand_lookups(context: &Context<'_>) -> TokenStream {
    let gates = context.loaded.topology.as_ref().map(|topology| Requirements::collect(context, topology));
    let lookups = context.types.lookups();
    if lookups.all.is_empty() {
        return TokenStream::new();
    }
    let Lookups { private, holder, not_found, all, .. } = lookups;
    let stand_in = match context.loaded.topology {
        Some(_) => quote!(pub struct #not_found(#private::PhantomPinned);),
        None => {
            let unknown = unknown_type_name(context);
            quote!(pub type #not_found = #unknown;)
        }
    };
    let lookups = all.iter().enumerate().map(|(index, lookup)| {
        let (outer, inner, found) = expand_scopes(lookup, not_found, context.span)?;
        // rustc names this macro in its own errors about the path.
        let gate = gates.as_ref().and_then(|gates| gates.first_gate(index)).unwrap_or_default();
        let name = format_ident!("type_of_gate_{}", gate.replace(['.', '-'], "_"));
        Some(quote_spanned! { context.span =>
            const _: () = {
                #outer
                const _: () = {
                    #inner
                    macro_rules! #name { () => { #found } }
                    impl #private::NamedType<#index> for #holder { type Type = #name!(); }
                };
            };
        })
    });
    quote_spanned! { context.span =>
        #[doc(hidden)]
        #[allow(dead_code, non_camel_case_types)]
        #stand_in
        #[doc(hidden)]
        #[allow(dead_code, non_camel_case_types)]
        struct #holder;
        #[allow(dead_code, unused_imports, non_camel_case_types, non_snake_case, clippy::all, clippy::pedantic)]
        const _: () = { #(#lookups)* };
    }
}

/// The stand-in, the import that hides it, and the path.
fn expand_scopes(lookup: &Lookup, not_found: &Ident, span: Span) -> Option<(TokenStream, TokenStream, TokenStream)> {
    let parts: Vec<&str> = lookup.dotted.split('.').collect();
    let (last, before) = parts.split_last()?;
    let last = segment(last, span)?;
    if lookup.starts_with == Start::Known {
        let parent = path(before.iter().copied(), span)?;
        let is_crate = !matches!(before.first(), Some(&("crate" | "self" | "super")));
        let root = is_crate.then(|| quote!(::));
        return Some((quote!(type #last = #not_found;), quote!(use #root #parent::*;), quote!(#last)));
    }
    let supers = before.iter().map(|_| quote!(super::));
    let stand_in = quote!(pub type #last = #(#supers)* #not_found;);
    let modules = before.iter().rev().try_fold(stand_in, |inner, name| {
        let name = segment(name, span)?;
        Some(quote!(pub mod #name { #inner }))
    })?;
    let import = quote! { use self::*; };
    Some((modules, import, path(parts, span)?))
}

/// What rustc checks where components are opened: that their types were found.
#[derive(Default)]
pub(super) struct Requirements {
    /// The types with the gates that use them, by the index of the type. Each has a trait that every type but the
    /// stand-in implements.
    traits: BTreeMap<usize, (TypeName, Vec<String>)>,
}

impl Requirements {
    pub(super) fn collect(context: &Context<'_>, topology: &Topology) -> Self {
        let mut all = Self::default();
        let index = &context.types.lookups().index;
        for included in topology.types().filter(|it| context.includes(it.name())) {
            for &id in included.component.gates() {
                for name in topology.gate(id).payload().types() {
                    let Some(&index) = index.get(name.dotted()) else { continue };
                    let (_, gates) = all.traits.entry(index).or_insert_with(|| (name.clone(), Vec::new()));
                    let gate = topology.gate_path(id);
                    // Name a gate only once, even if it uses this type for both request and reply.
                    if gates.last() != Some(&gate) {
                        gates.push(gate);
                    }
                }
            }
        }
        all
    }

    fn first_gate(&self, index: usize) -> Option<&str> {
        self.traits.get(&index)?.1.first().map(String::as_str)
    }

    /// The traits.
    pub(super) fn expand(&self, context: &Context<'_>) -> TokenStream {
        let traits = self.traits.iter().map(|(&index, (name, gates))| {
            let (name, report) = (trait_name(index), expand_report(context, name, gates));
            quote_spanned! { context.span =>
                #report
                trait #name {}
                // Implemented for a tuple: with an impl for the type itself, rustc would suggest a reference to it,
                // which implements the trait as well.
                #[diagnostic::do_not_recommend]
                impl<Type: ::core::marker::Unpin> #name for (Type,) {}
            }
        });
        quote!(#(#traits)*)
    }

    /// The bounds of the methods that open a component; nothing if it has no type that is looked up.
    ///
    /// rustc reports an unsatisfied bound where it is declared, unless the bound has a lifetime parameter.
    pub(super) fn expand_bounds(
        &self,
        context: &Context<'_>,
        topology: &Topology,
        component: &Component,
    ) -> TokenStream {
        let lookups = context.types.lookups();
        let names = component.gates().iter().flat_map(|&id| topology.gate(id).payload().types());
        let used: BTreeSet<usize> = names.filter_map(|name| lookups.index.get(name.dotted()).copied()).collect();
        if used.is_empty() {
            return TokenStream::new();
        }
        let bounds = used.into_iter().map(|index| {
            let Lookups { private, holder, .. } = lookups;
            let required = trait_name(index);
            quote!(for<'__any> (<#holder as #private::NamedType<#index>>::Type,): #required)
        });
        quote_spanned!(context.span => where #(#bounds),*)
    }
}

/// The stand-in as a message of every codec that it may be used with, so that components that are not opened compile.
pub(super) fn expand_stand_in_codecs<'t>(
    context: &Context<'_>,
    used: impl Iterator<Item = (&'t Payload, &'t Codec)>,
) -> TokenStream {
    let lookups = context.types.lookups();
    let private = &context.private;
    let may_miss = |payload: &Payload| payload.types().into_iter().any(|name| lookups.stand_in(name).is_some());
    let codecs: BTreeMap<&str, TokenStream> = used
        .filter(|(payload, codec)| may_miss(payload) && !matches!(codec, Codec::Path(_)))
        .map(|(_, codec)| (codec.word(), codec_type(context, codec)))
        .collect();
    let not_found = &lookups.not_found;
    let codecs = codecs.into_iter().map(|(word, codec)| {
        let module = format_ident!("{word}");
        quote_spanned!(context.span => #private::codecs::#module::stand_in!(#codec, #not_found);)
    });
    quote!(#(#codecs)*)
}

fn trait_name(index: usize) -> Ident {
    format_ident!("TypeIsFound_{index}")
}

fn expand_report(context: &Context<'_>, name: &TypeName, gates: &[String]) -> TokenStream {
    let code = TYPE_NOT_FOUND.code;
    let message = format!("[{code}] cannot find the Rust type `{}`", context.types.shown(name.dotted()));
    let place = note_with_excerpt(context, "the type is named here", name.span());
    on_unimplemented(&escape_braces(&message), &used_by(gates), &[remedy(context, name.dotted()), place])
}

fn used_by(gates: &[String]) -> String {
    let shown = quoted_list(gates.iter().take(MOST_GATES));
    match gates.len() {
        1 => format!("used by the gate {shown}"),
        0..=MOST_GATES => format!("used by the gates {shown}"),
        all => format!("used by the gates {shown} and {} more", all - MOST_GATES),
    }
}

fn remedy(context: &Context<'_>, dotted: &str) -> String {
    let lookups = context.types.lookups();
    let known = lookups.index.get(dotted).is_some_and(|&index| lookups.all[index].starts_with == Start::Known);
    let shown = dotted.replace('.', "::");
    match shown.rsplit_once("::") {
        Some((parent, last)) if known => format!("there is no `{last}` in `{parent}`, or it is private"),
        Some(_) => {
            let first = dotted.split('.').next().unwrap_or_default();
            format!("add the crate `{first}` to the dependencies, or bring a module `{first}` into scope with `use`")
        }
        None => format!("bring it into scope with `use`, or write its path, such as `my_crate.{dotted}`"),
    }
}
