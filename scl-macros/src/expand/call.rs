//! One call of the macro: what every part of the expansion needs to know.

use super::types::MessageTypes;
use crate::arguments::Arguments;
use proc_macro2::{Span, TokenStream};
use quote::quote;
use scl_loader::Loaded;
use scl_topology::source;
use syn::Ident;

/// What was called, and what came of it.
pub(super) struct Call<'a> {
    /// `$crate::private`, to start every path of the generated code.
    pub(super) private: TokenStream,
    /// The path literal's place: what is shown there reads as if the user had written it.
    pub(super) span: Span,
    /// The path as written.
    pub(super) path: String,
    /// The components that are wanted, if not all.
    pub(super) only: Option<&'a [Ident]>,
    /// What the file gave.
    pub(super) loaded: &'a Loaded,
    /// How message types are called in Rust.
    pub(super) types: MessageTypes,
}

impl<'a> Call<'a> {
    pub(super) fn new(arguments: &'a Arguments, loaded: &'a Loaded) -> Self {
        let krate = &arguments.krate;
        Self {
            private: quote!(#krate::private),
            span: arguments.path.span(),
            path: arguments.path.value(),
            only: arguments.only.as_deref(),
            loaded,
            types: MessageTypes::of(loaded),
        }
    }

    /// Whether a component is to be generated.
    pub(super) fn wants(&self, component: &str) -> bool {
        self.only.is_none_or(|only| only.iter().any(|wanted| names_component(wanted, component)))
    }

    /// `topology.yaml:14:9`, with the path as the user wrote it, so that no program contains a path of the machine that
    /// built it.
    pub(super) fn place(&self, span: source::Span) -> String {
        let at = self.loaded.sources.file(span.file).line_column(span.start);
        format!("{}:{}:{}", self.path, at.line, at.column)
    }
}

/// Whether `only` names this component: in Rust's spelling of an identifier, so `-` is written `_`.
pub(super) fn names_component(wanted: &Ident, component: &str) -> bool {
    wanted.to_string().trim_start_matches("r#") == component.replace('-', "_")
}
