//! A call in progress, which may be dropped at any time.

use super::Exchange;
use crate::state::WakeCall;
use crate::time::Watchdog;
use std::task::{Context, Poll};
use tokio::time::Instant;

/// A call in progress. However it ends, it hands the end back to the task.
pub(super) struct InCall<'a> {
    exchange: &'a Exchange,
    id: u64,
    watchdog: Option<Watchdog>,
}

impl<'a> InCall<'a> {
    pub(super) fn begin(exchange: &'a Exchange, id: u64) -> Self {
        Self { exchange, id, watchdog: exchange.calls.begin(id) }
    }

    /// Ready when the deadline has passed. Without its timer a call could wait forever, so a timer that fails ends it
    /// too.
    pub(super) fn poll_past(&mut self, cx: &mut Context<'_>, deadline: Instant) -> Poll<()> {
        self.watchdog.as_mut().map_or(Poll::Ready(()), |watchdog| watchdog.poll_past(cx, deadline).map(|_past| ()))
    }
}

impl Drop for InCall<'_> {
    fn drop(&mut self) {
        let mut end = self.exchange.lock();
        end.sent_calls.retain(|call| call.id != self.id);
        self.exchange.calls.end(self.id, self.watchdog.take());
        // Drive the end once more: this handles an event that has woken only this call, and makes the next one wake the
        // task or another call.
        if end.drive() {
            self.exchange.calls.wake_call();
        }
    }
}
