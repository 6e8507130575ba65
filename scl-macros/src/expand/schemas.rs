//! Compiled schemas: one module of Rust types for each protobuf package, their JSON, and the descriptors that programs
//! embed.

mod embedded;
#[cfg(feature = "protobuf")]
mod floats;
#[cfg(feature = "protobuf")]
mod json;
#[cfg(feature = "protobuf")]
mod modules;
#[cfg(not(feature = "protobuf"))]
mod switched_off;
mod unknown;

pub(super) use embedded::EmbeddedSchemas;
#[cfg(feature = "protobuf")]
pub(super) use modules::expand_messages;
#[cfg(all(test, feature = "protobuf"))]
pub(crate) use modules::generate_messages;
#[cfg(not(feature = "protobuf"))]
pub(super) use switched_off::expand_messages;
pub(super) use unknown::expand_unknown;
