//! The Rust names of everything that schemas declare, as prost generates them: one table that the checks and the macro
//! share.

#[cfg(feature = "protobuf")]
mod clash;
#[cfg(feature = "protobuf")]
mod declared;
#[cfg(feature = "protobuf")]
mod hidden_crate;
pub mod names;
#[cfg(feature = "protobuf")]
mod paths;
#[cfg(all(test, feature = "protobuf"))]
mod tests;

#[cfg(feature = "protobuf")]
pub(super) use clash::find_clashes;
#[cfg(feature = "protobuf")]
pub(super) use hidden_crate::find_hidden_crates;
#[cfg(feature = "protobuf")]
pub use paths::rust_paths;
