//! Long messages in shared memory, beside a connection's Unix socket.
//!
//! | file | contents |
//! |---|---|
//! | `sending` | the sending side of a connection: copying or lending, sending, falling back to the socket |
//! | `receiving` | the receiving side: one sample for each announcement |
//! | `listening` | what a listening end checks when it is opened |
//! | `absent` | the same without the feature `shm`: every message goes through the socket |
//!
//! The engine is the crate `scl-shm`. The commands of both sides are described in `docs/zeromq.md`.

#[cfg(not(feature = "shm"))]
mod absent;
#[cfg(feature = "shm")]
mod listening;
#[cfg(feature = "shm")]
mod receiving;
#[cfg(feature = "shm")]
mod sending;

#[cfg(not(feature = "shm"))]
pub(super) use absent::{Arriving, Offer, Sharing};
#[cfg(feature = "shm")]
pub(super) use listening::Offer;
#[cfg(feature = "shm")]
pub(super) use receiving::Arriving;
#[cfg(feature = "shm")]
pub(super) use sending::Sharing;

/// Messages up to this length go through the socket, which is faster for them.
#[cfg(feature = "shm")]
const INLINE: usize = 16 << 10;
