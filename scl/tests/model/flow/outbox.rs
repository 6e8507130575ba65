//! Model of a connection's queue at the sending gate: which message goes next, which wait, and which are dropped.

use super::layout::Declared;
use super::message::Message;
use crate::model::runner::Outcome;
use scl::private::WhenFull;
use std::collections::VecDeque;

pub(super) struct Outbox {
    declared: Declared,
    /// Whether the sending gate agreed to wait for this reader.
    backpressure: bool,
    /// Number of open links. For a moment there are two, when a new one replaces one whose reader has gone.
    links: usize,
    pub(super) waiting: VecDeque<Message>,
    /// The message of the call in progress, until it is handed over, queued or dropped.
    sending: Option<Message>,
    /// Whether the link has refused a message during the call in progress.
    refused: bool,
    /// Whether the link has refused a message since the queue was last empty.
    pub(super) holds_back: bool,
    pub(super) handed: u64,
    pub(super) lost: u64,
    pub(super) replaced: u64,
    pub(super) dropped_oldest: u64,
    pub(super) dropped_newest: u64,
}

impl Outbox {
    pub(super) fn new(declared: Declared, backpressure: bool) -> Self {
        Self {
            declared,
            backpressure,
            links: 0,
            waiting: VecDeque::new(),
            sending: None,
            refused: false,
            holds_back: false,
            handed: 0,
            lost: 0,
            replaced: 0,
            dropped_oldest: 0,
            dropped_newest: 0,
        }
    }

    pub(super) fn link_opens(&mut self) {
        self.links += 1;
        self.holds_back = false;
    }

    /// A link is dropped; its peer has not acknowledged this number of messages.
    pub(super) fn link_closes(&mut self, unacknowledged: u64) {
        self.links -= 1;
        self.lost += unacknowledged;
    }

    pub(super) fn is_connected(&self) -> bool {
        self.links > 0
    }

    pub(super) fn is_free(&self) -> bool {
        self.is_connected() && self.waiting.is_empty()
    }

    pub(super) fn is_full(&self) -> bool {
        self.waiting.len() >= self.declared.queue as usize
    }

    /// Returns true if one more message would have to wait. An optional reader that is not connected delays nobody.
    pub(super) fn would_wait(&self) -> bool {
        let for_reader = self.is_connected() || self.declared.required;
        self.backpressure && self.declared.when_full == WhenFull::Wait && for_reader && self.is_full()
    }

    /// A call sends a message, over this connection or another.
    pub(super) fn call_begins(&mut self) {
        self.refused = false;
    }

    /// The call in progress sends its message over this connection.
    pub(super) fn begins(&mut self, message: Message) {
        self.sending = Some(message);
    }

    pub(super) fn is_cancelled(&mut self) {
        self.sending = None;
    }

    /// The link accepted or refused a message, which must be the next one.
    pub(super) fn offered(&mut self, message: Message, accepted: bool) -> Outcome {
        let next = self.waiting.front().copied().or(self.sending);
        if next != Some(message) {
            return Err(format!("the link was given {message:?} instead of {next:?}"));
        }
        if !accepted {
            (self.refused, self.holds_back) = (true, true);
            return Ok(());
        }
        self.handed += 1;
        if self.waiting.pop_front().is_none() {
            self.sending = None;
        }
        Ok(())
    }

    /// The link was told that nothing more is waiting.
    pub(super) fn is_emptied(&mut self) -> Outcome {
        self.holds_back = false;
        match self.waiting.front() {
            Some(message) => Err(format!("the link was told that the queue is empty, and {message:?} is waiting")),
            None => Ok(()),
        }
    }

    /// The call is done. A message that the link did not accept waits, or one is dropped.
    pub(super) fn ends(&mut self) -> Outcome {
        let Some(message) = self.sending.take() else { return Ok(()) };
        if self.is_connected() && self.is_full() && !self.refused {
            return Err(format!("{message:?} came to a full queue, and the link was given nothing of it"));
        }
        if self.is_free() && !self.refused {
            return Err(format!("{message:?} was queued, and the link could have accepted it"));
        }
        if self.would_wait() {
            return Err(format!("{message:?} was sent although the queue is full and the sender has to wait"));
        }
        if self.is_full() && self.declared.when_full == WhenFull::DropNewest {
            self.dropped_newest += 1;
            return Ok(());
        }
        if self.is_full() {
            self.waiting.pop_front();
            // A queue of one drops its oldest also where the sender may not wait for it.
            let is_wanted =
                self.declared.queue == 1 && !(self.backpressure && self.declared.when_full == WhenFull::Wait);
            *if is_wanted { &mut self.replaced } else { &mut self.dropped_oldest } += 1;
        }
        self.waiting.push_back(message);
        Ok(())
    }
}
