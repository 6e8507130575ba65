//! Compiled schemas: one module of Rust types for each protobuf package, their JSON, and the descriptors that programs embed.

mod embedded;
#[cfg(feature = "protobuf")]
mod json;
#[cfg(feature = "protobuf")]
mod modules;
#[cfg(not(feature = "protobuf"))]
mod switched_off;
mod unknown;

pub(super) use embedded::EmbeddedSchemas;
#[cfg(feature = "protobuf")]
pub(super) use json::expand_json;
#[cfg(feature = "protobuf")]
pub(super) use modules::expand_modules;
#[cfg(not(feature = "protobuf"))]
pub(super) use switched_off::{expand_json, expand_modules};
pub(super) use unknown::expand_unknown;
