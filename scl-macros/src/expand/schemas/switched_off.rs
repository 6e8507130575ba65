//! Without the feature `protobuf`, the loader refuses `schemas:`, so nothing is generated from them.

use super::super::context::Context;
use proc_macro2::TokenStream;
use quote::quote;
use scl_topology::topology::{Component, Topology};

pub(in crate::expand) fn expand_modules(_: &Context<'_>) -> TokenStream {
    TokenStream::new()
}

pub(in crate::expand) fn expand_json(_: &Context<'_>) -> TokenStream {
    TokenStream::new()
}

pub(in crate::expand) struct EmbeddedSchemas;

impl EmbeddedSchemas {
    pub(in crate::expand) fn collect(_: &Context<'_>, _: &Topology) -> Self {
        Self
    }

    pub(in crate::expand) fn expand(&self, _: &Context<'_>) -> TokenStream {
        TokenStream::new()
    }

    pub(in crate::expand) fn of(&self, _: &Component) -> TokenStream {
        quote!(::core::option::Option::None)
    }
}
