//! Sending and receiving whole batches, which each transport and library does in its own way.

use super::BatchReport;
use super::message::{Message, sent_time};
use crate::clock::now;
use tokio::runtime::Runtime;

/// A sender of whole batches.
pub(super) trait BatchSender {
    /// Sends a message many times, as fast as possible.
    fn send_batch(&mut self, runtime: &Runtime, message: &Message, batch: usize) -> scl::Result<()>;
}

/// A receiver of whole batches.
pub(super) trait BatchReceiver {
    fn receive_batch(&mut self, runtime: &Runtime, batch: &mut Batch) -> scl::Result<()>;
}

/// The messages of a batch so far.
pub(super) struct Batch {
    missing: usize,
    /// When the first message was sent, rather than received: a sender that queues everything before it writes is not
    /// faster than one that writes at once.
    first_sent: Option<u64>,
    delays: Option<Vec<u64>>,
}

impl Batch {
    pub(super) fn new(size: usize, has_delays: bool) -> Self {
        Self { missing: size, first_sent: None, delays: has_delays.then(|| Vec::with_capacity(size)) }
    }

    pub(super) fn is_complete(&self) -> bool {
        self.missing == 0
    }

    pub(super) fn add(&mut self, message: &[u8]) -> scl::Result<()> {
        self.missing -= 1;
        if self.first_sent.is_none() {
            self.first_sent = Some(sent_time(message)?);
        }
        if let Some(delays) = &mut self.delays {
            delays.push(now().saturating_sub(sent_time(message)?));
        }
        Ok(())
    }

    /// The report of a batch whose last message has just arrived.
    pub(super) fn report(self) -> BatchReport {
        let now = now();
        let span = now.saturating_sub(self.first_sent.unwrap_or(now));
        BatchReport { span, delays: self.delays.unwrap_or_default() }
    }
}
