//! What every part of an expansion needs to know about the macro invocation.

use super::types::{Lookups, MessageTypes};
use crate::arguments::Arguments;
use crate::locate::Surroundings;
use proc_macro2::{Span, TokenStream};
use quote::quote;
use scl_loader::Loaded;
use scl_topology::source;
use std::collections::BTreeSet;
use syn::Ident;

/// One invocation of `topology!` and the file it loaded.
pub(super) struct Context<'a> {
    /// `$crate::private`, the start of every path in the generated code.
    pub(super) private: TokenStream,
    /// The span of the path literal. Tokens with this span are reported as if the user had written them there.
    pub(super) span: Span,
    /// The path as the user wrote it.
    pub(super) path: String,
    /// The components to generate; `None` for all.
    pub(super) only: Option<&'a [Ident]>,
    /// `#[cfg(test)]`, or nothing if other crates are to test the components.
    pub(super) for_tests: TokenStream,
    /// Whether the code is shown in an editor, and not compiled.
    pub(super) for_editor: bool,
    /// The loaded topology file, with its schemas and diagnostics.
    pub(super) loaded: &'a Loaded,
    /// The crates that the program can name, if they are known.
    extern_crates: Option<&'a BTreeSet<String>>,
    /// The Rust paths of the message types.
    pub(super) types: MessageTypes,
}

impl<'a> Context<'a> {
    pub(super) fn new(arguments: &'a Arguments, loaded: &'a Loaded, surroundings: &'a Surroundings) -> Self {
        let krate = &arguments.krate;
        let private = quote!(#krate::private);
        let path = arguments.path.value();
        let only = arguments.only.as_deref();
        let extern_crates = surroundings.extern_crates.as_ref();
        let name = as_identifier(&path_and_only(&path, only));
        let lookups = |types| Lookups::new(&name, &private, extern_crates, types);
        let types = MessageTypes::of(loaded, |component| includes(only, component), lookups);
        let for_tests = if arguments.testable == Some(true) { quote!() } else { quote!(#[cfg(test)]) };
        let (span, for_editor) = (arguments.path.span(), surroundings.for_editor);
        Self { private, for_tests, for_editor, span, path, only, loaded, extern_crates, types }
    }

    /// Returns true if a component is to be generated.
    pub(super) fn includes(&self, component: &str) -> bool {
        includes(self.only, component)
    }

    /// Returns true if the program depends on a crate of this name.
    pub(super) fn is_extern_crate(&self, name: &str) -> bool {
        self.extern_crates.is_some_and(|crates| crates.contains(name))
    }

    /// The location of a declaration: `topology.yaml:14:9`. The path is the one that the user wrote, so that no program
    /// contains an absolute path of the machine that built it.
    pub(super) fn location(&self, span: source::Span) -> String {
        self.loaded.place(span, &self.path)
    }

    /// The path as part of an identifier, so that two invocations in one module do not generate the same name.
    pub(super) fn path_as_identifier(&self) -> String {
        as_identifier(&self.path)
    }
}

fn includes(only: Option<&[Ident]>, component: &str) -> bool {
    only.is_none_or(|only| only.iter().any(|wanted| names_component(wanted, component)))
}

/// Returns the path with the components in `only`: two invocations may generate different components of one file in one
/// module.
fn path_and_only(path: &str, only: Option<&[Ident]>) -> String {
    only.unwrap_or_default().iter().fold(path.to_owned(), |name, component| format!("{name}_{component}"))
}

fn as_identifier(path: &str) -> String {
    path.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect()
}

/// Returns true if an entry of `only` names this component. Identifiers cannot contain `-`, so `_` stands for it.
pub(super) fn names_component(wanted: &Ident, component: &str) -> bool {
    wanted.to_string().trim_start_matches("r#") == component.replace('-', "_")
}
