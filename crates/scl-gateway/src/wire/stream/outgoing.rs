//! The decisions of a sending end: what to send, what to send again, what to give up.
//!
//! ```text
//!   push        emit            the component has it
//!   ────▶ kept ─────▶ on its way ───────────────────▶ settled
//!          ▲              │ │                            ▲
//!          └──────────────┘ └────────────────────────────┘
//!        lost, or matched     another receiver is matched: given up
//!        with the same one
//! ```
//!
//! `waiting` holds the messages that are kept or on their way, in this order: the first `emitted` are on their way, the
//! next ones up to `tried` were on their way before, and the rest never were.

use std::collections::VecDeque;
use std::time::Instant;

use bytes::Bytes;

use crate::wire::header::{Ack, Header, Kind};
use crate::wire::{WINDOW_BYTES, WINDOW_MESSAGES};

/// Messages that are sent and not acknowledged, with their progress.
#[derive(Debug, Default)]
pub(super) struct Outgoing {
    window: usize,
    stream: u64,
    /// The receiving end that the numbers belong to.
    epoch: Option<u64>,
    matched: bool,
    waiting: VecDeque<Waiting>,
    waiting_bytes: u64,
    /// Whether the sender keeps its last message for receivers that join.
    latches: bool,
    /// How many of `waiting` are on their way.
    emitted: usize,
    /// How many of `waiting` were ever on their way to `epoch`.
    tried: usize,
    attempt: u32,
    /// Messages settled (acknowledged, given up or abandoned) in all, and how many of them before this stream.
    settled: u64,
    base: u64,
    /// Whether a flush is requested, and how many messages in all it covers.
    flush: bool,
    flushed: u64,
}

/// A message that is not acknowledged.
#[derive(Debug)]
struct Waiting {
    message: Bytes,
    /// When it was sent, if the sender keeps its last message for receivers that join.
    sent: Option<Instant>,
    /// Whether it was sent before its receiver had joined.
    is_latched: bool,
}

impl Outgoing {
    pub(super) fn new(queue: u32, latches: bool, stream: u64) -> Self {
        let window = queue.clamp(1, WINDOW_MESSAGES) as usize;
        Outgoing { window, stream, latches, ..Outgoing::default() }
    }

    /// Whether this is not the receiving end that was matched last.
    pub(super) fn is_new(&self, epoch: u64) -> bool {
        self.epoch != Some(epoch)
    }

    pub(super) fn is_matched(&self) -> bool {
        self.matched
    }

    pub(super) fn unacknowledged(&self) -> usize {
        self.waiting.len()
    }

    /// Whether an acknowledgement is outstanding.
    pub(super) fn awaits_answer(&self) -> bool {
        self.matched && self.emitted > 0
    }

    pub(super) fn may_push(&self, length: usize) -> bool {
        let fits = self.waiting_bytes + length as u64 <= WINDOW_BYTES || self.waiting.is_empty();
        self.matched && fits && self.waiting.len() < self.window
    }

    /// Adds a message. `latched` is when it was sent, if that was before the receiver had joined.
    pub(super) fn push(&mut self, message: Bytes, latched: Option<Instant>) {
        self.waiting_bytes += message.len() as u64;
        let sent = latched.or_else(|| self.latches.then(Instant::now));
        self.waiting.push_back(Waiting { message, sent, is_latched: latched.is_some() });
    }

    /// Begins or resumes with a receiving end. Returns how many messages are given up.
    pub(super) fn matched(&mut self, epoch: u64) -> u64 {
        self.matched = true;
        if !self.is_new(epoch) {
            self.start_over(0);
            return 0;
        }
        let given_up = self.tried;
        self.settle(given_up);
        self.epoch = Some(epoch);
        self.base = self.settled;
        self.attempt = 0;
        (self.emitted, self.tried) = (0, 0);
        if let Some(last) = self.waiting.back_mut() {
            last.is_latched |= self.latches;
        }
        given_up as u64
    }

    pub(super) fn unmatched(&mut self) {
        self.matched = false;
    }

    /// Forgets all messages and begins a new stream, so that the receiving end does not wait for them.
    pub(super) fn abandon(&mut self, stream: u64) {
        self.settle(self.waiting.len());
        self.stream = stream;
        self.base = self.settled;
        self.attempt = 0;
        (self.emitted, self.tried) = (0, 0);
    }

    /// Returns the next message to send, if the window allows it.
    pub(super) fn emit(&mut self) -> Option<(Header, Bytes)> {
        let next = self.waiting.get(self.emitted).filter(|_| self.matched && self.emitted < self.window)?;
        let (message, latched) = (next.message.clone(), next.sent.filter(|_| next.is_latched));
        self.emitted += 1;
        self.tried = self.tried.max(self.emitted);
        self.check();
        Some((Header { latched, ..self.header(Kind::Whole)? }, message))
    }

    /// Returns a header that asks for an acknowledgement; `None` without a match.
    pub(super) fn probe(&self) -> Option<Header> {
        self.matched.then(|| self.header(Kind::Probe { flush: self.flush })).flatten()
    }

    /// Requests a flush of the messages in flight. Returns false if it was requested already.
    pub(super) fn request_flush(&mut self) -> bool {
        let last = self.settled + self.emitted as u64;
        let is_news = !self.flush || self.flushed < last;
        (self.flush, self.flushed) = (true, last);
        is_news
    }

    /// Handles an acknowledgement. Messages that turn out to be lost are emitted again.
    pub(super) fn acknowledged(&mut self, ack: &Ack) -> Progress {
        let mut progress = Progress::default();
        if ack.stream != self.stream || Some(ack.epoch) != self.epoch {
            return progress;
        }
        let last = self.settled - self.base + self.tried as u64;
        let taken = ack.taken.min(last).saturating_sub(self.settled - self.base);
        if taken > 0 {
            self.settle(taken as usize);
            self.flush &= !self.waiting.is_empty();
            progress.settled = Some(self.settled);
        }
        if self.matched && ack.attempt == self.attempt && ack.received < ack.seen && ack.received < last {
            let arrived = ack.received.saturating_sub(self.settled - self.base) as usize;
            if arrived < self.emitted {
                self.start_over(arrived);
                progress.started_over = true;
            }
        }
        progress
    }

    fn start_over(&mut self, arrived: usize) {
        self.emitted = arrived.min(self.waiting.len());
        self.attempt = self.attempt.wrapping_add(1);
    }

    fn settle(&mut self, count: usize) {
        for waiting in self.waiting.drain(..count) {
            self.waiting_bytes -= waiting.message.len() as u64;
        }
        self.emitted = self.emitted.saturating_sub(count);
        self.tried = self.tried.saturating_sub(count);
        self.settled += count as u64;
        self.check();
    }

    fn check(&self) {
        let (emitted, tried, waiting) = (self.emitted, self.tried, self.waiting.len());
        debug_assert!(emitted <= tried && tried <= waiting, "{emitted} on their way, {tried} tried, {waiting} waiting");
        debug_assert!(emitted <= self.window, "{emitted} messages in a window of {}", self.window);
        debug_assert!(self.base <= self.settled, "no message of this stream is settled twice");
        debug_assert_eq!(
            self.waiting_bytes,
            self.waiting.iter().map(|waiting| waiting.message.len() as u64).sum::<u64>()
        );
    }

    fn header(&self, kind: Kind) -> Option<Header> {
        let sequence = self.settled - self.base + self.emitted as u64;
        Some(Header { kind, stream: self.stream, epoch: self.epoch?, attempt: self.attempt, sequence, latched: None })
    }
}

/// What an acknowledgement changed.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Progress {
    /// Messages settled in all, if more than before.
    pub(super) settled: Option<u64>,
    /// Whether messages are emitted again, so that copies which have not left yet are superfluous.
    pub(super) started_over: bool,
}

#[cfg(test)]
mod tests;
