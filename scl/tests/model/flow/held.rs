//! The model of a connection's sending end: which message goes next, which wait, and which are dropped.

use super::layout::Declared;
use super::message::Message;
use crate::trial::Outcome;
use scl::private::WhenFull;
use std::collections::VecDeque;

/// How many messages are written one by one before the connection's task is left to write what follows.
const ONE_BY_ONE: usize = 32;

pub(super) struct Held {
    declared: Declared,
    /// Whether the sender agreed to wait for this reader.
    backpressure: bool,
    /// Whether the transport has reported the reader as there.
    pub(super) present: bool,
    pub(super) waiting: VecDeque<Message>,
    /// The message that is being sent, until it has found its place.
    sending: Option<Message>,
    /// Whether the transport gave that one back, or one before it meanwhile.
    refused: bool,
    /// How many messages the transport took since the connection's task had its turn, at once and after they waited.
    at_once: usize,
    after_waiting: usize,
    pub(super) sent: u64,
    pub(super) dropped_oldest: u64,
    pub(super) dropped_newest: u64,
}

impl Held {
    pub(super) fn new(declared: Declared, backpressure: bool) -> Self {
        Self {
            declared,
            backpressure,
            present: false,
            waiting: VecDeque::new(),
            sending: None,
            refused: false,
            at_once: 0,
            after_waiting: 0,
            sent: 0,
            dropped_oldest: 0,
            dropped_newest: 0,
        }
    }

    pub(super) fn is_free(&self) -> bool {
        self.present && self.waiting.is_empty()
    }

    pub(super) fn is_full(&self) -> bool {
        self.waiting.len() >= self.declared.queue as usize
    }

    /// Whether one more message would have to wait for room: an optional reader that is not there keeps nobody waiting.
    pub(super) fn makes_wait(&self) -> bool {
        self.waits() && self.is_full()
    }

    fn waits(&self) -> bool {
        let for_peer = self.present || self.declared.required;
        self.backpressure && self.declared.when_full == WhenFull::Wait && for_peer
    }

    /// A message is about to be sent, to this reader or another.
    pub(super) fn may_be_offered(&mut self) {
        self.refused = false;
    }

    pub(super) fn begins(&mut self, message: Message) {
        self.sending = Some(message);
    }

    /// The connection's task has its turn.
    pub(super) fn has_its_turn(&mut self) {
        (self.at_once, self.after_waiting) = (0, 0);
    }

    /// Whether so many messages follow each other that the next ones may be left to the task.
    fn is_in_a_burst(&self) -> bool {
        self.at_once >= ONE_BY_ONE || (self.at_once > 0 && self.after_waiting >= ONE_BY_ONE)
    }

    /// The message is not sent after all.
    pub(super) fn is_called_off(&mut self) {
        self.sending = None;
    }

    /// A message was offered to the transport: it must be the next one.
    pub(super) fn offered(&mut self, message: Message, taken: bool) -> Outcome {
        let next = self.waiting.front().copied().or(self.sending);
        if next != Some(message) {
            return Err(format!("{message:?} was offered to the transport instead of {next:?}"));
        }
        match (taken, self.waiting.is_empty()) {
            (false, _) => self.refused = true,
            (true, true) => {
                self.sending = None;
                self.at_once += 1;
            }
            (true, false) => {
                self.waiting.pop_front();
                self.after_waiting += 1;
            }
        }
        self.sent += u64::from(taken);
        Ok(())
    }

    /// The message is sent: if the transport did not take it, it waits, or one of those that wait is dropped.
    pub(super) fn ends(&mut self) -> Outcome {
        let Some(message) = self.sending.take() else { return Ok(()) };
        if self.present && self.is_full() && !self.refused {
            return Err(format!("{message:?} came to a full queue, of which the reader was offered nothing"));
        }
        if self.is_free() && !self.refused && !self.is_in_a_burst() {
            return Err(format!("{message:?} was kept from a reader that could have been offered it"));
        }
        if self.makes_wait() {
            return Err(format!("{message:?} was sent to a full queue that had to be waited for"));
        }
        if self.is_full() && self.declared.when_full == WhenFull::DropNewest {
            self.dropped_newest += 1;
            return Ok(());
        }
        if self.is_full() {
            self.waiting.pop_front();
            self.dropped_oldest += 1;
        }
        self.waiting.push_back(message);
        Ok(())
    }
}
