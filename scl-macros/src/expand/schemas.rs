//! Compiled schemas: one module of Rust types for each protobuf package, and the descriptors that programs embed.

mod embedded;
#[cfg(feature = "protobuf")]
mod modules;
#[cfg(not(feature = "protobuf"))]
mod switched_off;

pub(super) use embedded::EmbeddedSchemas;
#[cfg(feature = "protobuf")]
pub(super) use modules::expand_modules;
#[cfg(not(feature = "protobuf"))]
pub(super) use switched_off::expand_modules;
