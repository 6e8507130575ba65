//! Without the feature `protobuf`, the loader refuses `schemas:`, so nothing is generated from them.

use super::super::context::Context;
use proc_macro2::TokenStream;

pub(in crate::expand) fn expand_messages(_: &Context<'_>) -> TokenStream {
    TokenStream::new()
}
