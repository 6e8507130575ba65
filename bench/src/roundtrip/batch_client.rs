//! Exchanging whole batches, which each transport and library does in its own way.

use scl::bytes::Bytes;
use std::time::Instant;
use tokio::runtime::Runtime;

/// A client that exchanges whole batches.
pub(super) trait BatchClient {
    /// Sends messages one after the other, each when the previous one has returned, and calls `record` after each with
    /// the time at which it was sent.
    fn exchange(
        &mut self,
        runtime: &Runtime,
        message: &Bytes,
        messages: usize,
        record: &mut dyn FnMut(Instant),
    ) -> scl::Result<()>;
}
