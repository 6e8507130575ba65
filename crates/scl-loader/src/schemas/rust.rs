//! The Rust names of everything that schemas declare, as prost generates them: one table that the checks and the macro
//! share.

#[cfg(feature = "protobuf")]
mod clash;
#[cfg(feature = "protobuf")]
mod declared;
#[cfg(feature = "protobuf")]
mod hidden_crate;
#[cfg(feature = "protobuf")]
mod judge;
pub mod names;
#[cfg(feature = "protobuf")]
mod paths;
#[cfg(all(test, feature = "protobuf"))]
mod tests;

#[cfg(feature = "protobuf")]
pub(super) use judge::judge_names;
#[cfg(feature = "protobuf")]
pub use paths::rust_paths;
