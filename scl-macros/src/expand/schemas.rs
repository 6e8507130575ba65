//! Compiled schemas become modules with prost types, one a protobuf package.

#[cfg(feature = "protobuf")]
mod modules;
#[cfg(feature = "protobuf")]
mod rust_paths;

#[cfg(feature = "protobuf")]
pub(super) use modules::expand_schemas;
#[cfg(feature = "protobuf")]
pub(super) use rust_paths::rust_paths;

/// Without the feature there is nothing to expand: the loader has refused `schemas:`.
#[cfg(not(feature = "protobuf"))]
pub(super) fn expand_schemas(_: &super::call::Call<'_>) -> proc_macro2::TokenStream {
    proc_macro2::TokenStream::new()
}
