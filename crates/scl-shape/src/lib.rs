//! Compares the shapes of protobuf messages: whether two SCL programs mean the same by the same bytes.
//!
//! The runtime compares before it connects, and `scl diff` before anything is built, with the same words.
#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod compare;
mod declared;
mod memory;
#[cfg(feature = "reflect")]
mod negative_zero;
mod texts;
mod wire;

pub use compare::{Difference, Encoding, What, compare, differences};
pub use memory::{Format, Language, MemoryEstimate, NotJson};
#[cfg(feature = "reflect")]
pub use negative_zero::{encode, loses_sign};
pub use prost::DecodeError;
pub use prost_types::FileDescriptorSet;
pub use texts::TextCheck;

use prost::Message;

/// Decodes what a program embeds: a serialized `google.protobuf.FileDescriptorSet`.
///
/// # Errors
/// The bytes are not a `FileDescriptorSet`.
pub fn decode(descriptors: &[u8]) -> Result<FileDescriptorSet, DecodeError> {
    FileDescriptorSet::decode(descriptors)
}
