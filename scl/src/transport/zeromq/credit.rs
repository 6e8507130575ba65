//! Credit between SCL ends: how much may be in flight, and what has been acknowledged.

use super::zmtp::{ProtocolError, SclReady};
use crate::transport::{Endpoint, Window};
use scl_plan::memory::limits::{NEWEST_WINDOW_BYTES, NEWEST_WINDOW_MESSAGES, WINDOW_BYTES, WINDOW_MESSAGES};
use std::collections::VecDeque;

/// What an ordinary receiving end allows in flight.
pub(super) const WINDOW: Window = Window { messages: WINDOW_MESSAGES, bytes: WINDOW_BYTES };
/// The same if only the newest message matters.
const NEWEST_WINDOW: Window = Window { messages: NEWEST_WINDOW_MESSAGES, bytes: NEWEST_WINDOW_BYTES };
/// Maximum number of unacknowledged messages to remember, whatever window a peer announces.
const MOST_MESSAGES: u64 = 1 << 16;

/// Returns what a receiving end announces.
pub(super) fn receiving(endpoint: &Endpoint) -> SclReady {
    SclReady { window: Some(window(endpoint)), newest_only: endpoint.newest_only, ..SclReady::default() }
}

fn window(endpoint: &Endpoint) -> Window {
    endpoint.deferred.unwrap_or(if endpoint.newest_only { NEWEST_WINDOW } else { WINDOW })
}

/// At a sending end: what is in flight.
pub(super) struct SendCredit {
    window: Window,
    sent: u64,
    /// Number of messages that the peer's program has received.
    received: u64,
    /// Lengths of the messages that are not acknowledged, the oldest first.
    in_flight: VecDeque<usize>,
    bytes: u64,
}

impl SendCredit {
    pub(super) fn new(mut window: Window) -> Self {
        window.messages = window.messages.min(MOST_MESSAGES);
        Self { window, sent: 0, received: 0, in_flight: VecDeque::new(), bytes: 0 }
    }

    /// Returns true if another message may be sent after the given number of others with that total length. One that is
    /// longer than the window may be sent as well.
    pub(super) fn is_open_after(&self, messages: usize, bytes: usize) -> bool {
        ((self.in_flight.len() + messages) as u64) < self.window.messages
            && self.bytes + (bytes as u64) < self.window.bytes
    }

    pub(super) fn count_sent(&mut self, length: usize) {
        self.sent += 1;
        self.in_flight.push_back(length);
        self.bytes += length as u64;
    }

    pub(super) fn sent(&self) -> u64 {
        self.sent
    }

    pub(super) fn unacknowledged(&self) -> u64 {
        self.in_flight.len() as u64
    }

    pub(super) fn not_received(&self) -> u64 {
        self.sent - self.received
    }

    /// Handles an acknowledgement: of all messages sent so far, the peer's gate has taken the first `acknowledged`, and
    /// its program has received `received`.
    pub(super) fn acknowledge(&mut self, acknowledged: u64, received: u64) -> Result<(), ProtocolError> {
        let remaining = self
            .sent
            .checked_sub(acknowledged)
            .ok_or(ProtocolError::Acknowledgement { acknowledged, sent: self.sent })?;
        while self.in_flight.len() as u64 > remaining {
            self.bytes -= self.in_flight.pop_front().unwrap_or_default() as u64;
        }
        self.received = self.received.max(received.min(acknowledged));
        debug_assert!(self.received + self.unacknowledged() <= self.sent, "received before it was acknowledged");
        debug_assert!(self.unacknowledged() > 0 || self.bytes == 0, "bytes are in flight without a message");
        Ok(())
    }
}

/// At a receiving end: what has been taken and not acknowledged yet.
pub(super) struct ReceiveCredit {
    window: Window,
    taken: u64,
    /// Number of the taken messages that the program has received, or its gate has dropped.
    received: u64,
    /// The value of `received` at which the sender has asked to be notified.
    awaited: Option<u64>,
    unacknowledged: u64,
    unacknowledged_bytes: u64,
    deferred: Option<Deferred>,
}

/// State of an end whose caller acknowledges the messages.
#[derive(Default)]
struct Deferred {
    acknowledged: u64,
    /// Numbers of the messages that the caller has not seen, because they were malformed, and thus never acknowledges.
    skipped: VecDeque<u64>,
}

impl ReceiveCredit {
    pub(super) fn new(endpoint: &Endpoint) -> Self {
        let deferred = endpoint.deferred.map(|_| Deferred::default());
        let window = window(endpoint);
        Self { window, taken: 0, received: 0, awaited: None, unacknowledged: 0, unacknowledged_bytes: 0, deferred }
    }

    /// Counts a message. Returns true if half of the window waits to be acknowledged.
    pub(super) fn count_taken(&mut self, length: usize) -> bool {
        self.taken += 1;
        if self.deferred.is_some() {
            return false;
        }
        self.unacknowledged += 1;
        self.unacknowledged_bytes += length as u64;
        2 * self.unacknowledged >= self.window.messages || 2 * self.unacknowledged_bytes >= self.window.bytes
    }

    /// Number of messages taken so far.
    pub(super) fn taken(&self) -> u64 {
        self.taken
    }

    /// Whether the caller acknowledges messages.
    pub(super) fn is_deferred(&self) -> bool {
        self.deferred.is_some()
    }

    /// Notes that the caller will not see the message counted last. Returns the numbers to acknowledge, if any.
    pub(super) fn skip_last(&mut self) -> Option<(u64, u64)> {
        let deferred = self.deferred.as_mut()?;
        deferred.skipped.push_back(self.taken);
        deferred.advance(0)
    }

    /// Acknowledges the oldest messages that the caller has seen. Returns the numbers to acknowledge, if any.
    pub(super) fn acknowledge_deferred(&mut self, count: u64) -> Option<(u64, u64)> {
        self.deferred.as_mut()?.advance(count)
    }

    pub(super) fn unacknowledged(&self) -> u64 {
        self.unacknowledged
    }

    /// Notes that the program has received all but the given number of messages. Returns true if the sender is to be
    /// notified.
    pub(super) fn note_waiting(&mut self, waiting: u64) -> bool {
        // `waiting` may include messages of an earlier connection.
        self.received = self.received.max(self.taken.saturating_sub(waiting));
        self.awaited.take_if(|awaited| *awaited <= self.received).is_some()
    }

    /// Whether the sender waits to be notified.
    pub(super) fn is_awaited(&self) -> bool {
        self.awaited.is_some()
    }

    /// Notes that the sender wants to know when the program has received everything taken so far.
    pub(super) fn await_received(&mut self) {
        self.awaited = (self.received < self.taken).then_some(self.taken);
    }

    /// Returns the numbers to acknowledge: of messages taken, and received by the program.
    pub(super) fn acknowledge(&mut self) -> (u64, u64) {
        (self.unacknowledged, self.unacknowledged_bytes) = (0, 0);
        debug_assert!(self.received <= self.taken, "the program has received more than was taken");
        (self.taken, self.received)
    }
}

impl Deferred {
    /// Notes that the caller has acknowledged `count` more messages, and returns the numbers to acknowledge, if any.
    /// These messages count as received by a program, too.
    fn advance(&mut self, count: u64) -> Option<(u64, u64)> {
        let before = self.acknowledged;
        self.pass_skipped();
        for _ in 0..count {
            self.acknowledged += 1;
            self.pass_skipped();
        }
        debug_assert!(
            self.skipped.front().is_none_or(|&number| number > self.acknowledged),
            "acknowledged out of order"
        );
        (self.acknowledged > before).then_some((self.acknowledged, self.acknowledged))
    }

    fn pass_skipped(&mut self) {
        while self.skipped.front().is_some_and(|&number| number == self.acknowledged + 1) {
            self.skipped.pop_front();
            self.acknowledged += 1;
        }
    }
}
