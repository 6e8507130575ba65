//! Model of the receiving gate: its queue, which applies to what has arrived.

use super::layout::Declared;
use super::message::Message;
use crate::model::runner::Outcome;
use scl::private::WhenFull;
use std::collections::VecDeque;

pub(super) struct Inbox {
    declared: Declared,
    pub(super) waiting: VecDeque<Message>,
    call: Call,
    /// Whether the last waiting call found nothing, and nothing has arrived since.
    was_empty: bool,
    /// Whether the reader has called for the next message, and was given none yet.
    has_called: bool,
    /// What its sender held back when it first called.
    owed: Option<Message>,
    /// The message that the call has, before it returns: the first that arrives for a call that waited, or one from the
    /// queue.
    direct: Option<Message>,
    pub(super) received: u64,
    pub(super) replaced: u64,
    pub(super) dropped_oldest: u64,
    pub(super) dropped_newest: u64,
}

/// The call in progress.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Call {
    None,
    /// For the next message, and waits for it.
    Next,
    /// For the next message if there is one.
    TryNext,
    /// For the newest message, passing over the others.
    Newest,
}

impl Inbox {
    pub(super) fn new(declared: Declared) -> Self {
        Self {
            declared,
            waiting: VecDeque::new(),
            call: Call::None,
            was_empty: false,
            has_called: false,
            owed: None,
            direct: None,
            received: 0,
            replaced: 0,
            dropped_oldest: 0,
            dropped_newest: 0,
        }
    }

    pub(super) fn arrives(&mut self, message: Message) -> Outcome {
        self.received += 1;
        let waited = std::mem::take(&mut self.was_empty);
        if waited && self.call == Call::Next && !self.is_newest_only() {
            self.direct = Some(message);
            return Ok(());
        }
        let full = self.waiting.len() >= self.declared.queue as usize;
        match self.declared.when_full {
            WhenFull::DropNewest if full => {
                self.dropped_newest += 1;
                return Ok(());
            }
            WhenFull::DropOldest if full => {
                self.waiting.pop_front();
                *if self.is_newest_only() { &mut self.replaced } else { &mut self.dropped_oldest } += 1;
            }
            WhenFull::Wait if full && self.call != Call::Newest => {
                // There is room once the call has its message, and then nobody else may look for the next one.
                if self.call == Call::None || self.direct.is_some() {
                    return Err(format!("{message:?} was taken from the transport, and the queue is full"));
                }
                self.direct = self.waiting.pop_front();
            }
            _ => {}
        }
        self.waiting.push_back(message);
        Ok(())
    }

    /// Number of messages of a sender that wait.
    pub(super) fn waiting_of(&self, sender: u32) -> u64 {
        self.waiting.iter().filter(|message| message.sender == sender).count() as u64
    }

    pub(super) fn begins(&mut self, call: Call, held_back: Option<Message>) {
        self.call = call;
        if call == Call::Next && !std::mem::replace(&mut self.has_called, true) {
            self.owed = held_back;
        }
        self.was_empty &= call == Call::Next;
    }

    /// What a call that waits must not return an older message than, if the reader wants the newest.
    pub(super) fn owed(&self) -> Option<Message> {
        self.owed.filter(|_| self.is_newest_only() && self.call == Call::Next)
    }

    /// The call is done. `catches_up`: it may return nothing because its sender holds back a newer message.
    pub(super) fn ends(&mut self, given: Option<Message>, catches_up: bool) -> Outcome {
        let call = std::mem::replace(&mut self.call, Call::None);
        self.has_called &= call != Call::Next || given.is_none();
        if given.is_none() && catches_up && self.is_newest_only() && call == Call::Next {
            return Ok(());
        }
        let expected = match call {
            Call::Newest => {
                let newest = self.waiting.pop_back();
                self.waiting.clear();
                newest
            }
            _ => self.direct.take().or_else(|| self.waiting.pop_front()),
        };
        self.was_empty = call == Call::Next && given.is_none();
        if given == expected { Ok(()) } else { Err(format!("the reader was given {given:?} instead of {expected:?}")) }
    }

    /// Returns true if it makes its sender wait, and so takes in no more than it has room for.
    pub(super) fn waits(&self) -> bool {
        self.declared.when_full == WhenFull::Wait
    }

    pub(super) fn is_newest_only(&self) -> bool {
        self.declared.is_newest_only()
    }
}
