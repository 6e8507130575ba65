//! The message: of fixed size, so that its codec does not allocate.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// 20 bytes, as in the paper.
#[derive(Debug, Clone, Default, FromBytes, IntoBytes, KnownLayout, Immutable)]
#[repr(C)]
pub(super) struct Reading {
    values: [u32; 5],
}
