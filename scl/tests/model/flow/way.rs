//! What the transport promises between the two gates.

use super::message::Message;
use crate::trial::Outcome;
use std::collections::VecDeque;

/// What may be lost on the way, declared by nobody.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Promise {
    /// What is taken arrives, unless the reader vanishes first; nothing is taken for a reader that vanished.
    Exact,
    /// `docs/zeromq.md`: what is taken may be lost with the end that vanishes. Of a reader that is also what is taken
    /// before the sender notices; from the first message that arrives at its successor on, nothing is lost any more.
    /// A sender that was flushed before it vanished loses nothing.
    LostWithAPeer,
}

impl Promise {
    pub(super) fn is_exact(self) -> bool {
        self == Self::Exact
    }
}

/// The messages that were taken and have not arrived.
pub(super) struct Way {
    promise: Promise,
    messages: VecDeque<OnTheWay>,
    reader: bool,
    /// Whether a reader vanished and the sender may not have noticed.
    unnoticed: bool,
}

struct OnTheWay {
    message: Message,
    may_be_lost: bool,
}

impl Way {
    pub(super) fn new(promise: Promise) -> Self {
        Self { promise, messages: VecDeque::new(), reader: false, unnoticed: false }
    }

    pub(super) fn has_reader(&self) -> bool {
        self.reader
    }

    /// How many messages must still arrive.
    pub(super) fn due(&self) -> usize {
        self.messages.iter().filter(|one| !one.may_be_lost).count()
    }

    pub(super) fn takes(&mut self, message: Message) -> Outcome {
        let exact = self.promise.is_exact();
        if exact && !self.reader {
            return Err(format!("{message:?} was taken for nobody"));
        }
        self.messages.push_back(OnTheWay { message, may_be_lost: !exact && (self.unnoticed || !self.reader) });
        Ok(())
    }

    /// A message arrived: the next one of its sender, whatever another sender sent before it vanished.
    pub(super) fn arrives(&mut self, message: Message) -> Outcome {
        let lost = |one: &OnTheWay| one.message.sender == message.sender && one.may_be_lost && one.message < message;
        self.messages.retain(|one| !lost(one));
        let next = self.messages.iter().position(|one| one.message.sender == message.sender);
        let Some(next) = next.and_then(|place| self.messages.remove(place)) else {
            return Err(format!("{message:?} arrived a second time, or at a reader that it was not sent to"));
        };
        if next.message != message {
            return Err(format!("{message:?} arrived before {:?}", next.message));
        }
        self.unnoticed = false;
        Ok(())
    }

    pub(super) fn reader_comes(&mut self) {
        self.reader = true;
    }

    pub(super) fn reader_goes(&mut self) {
        self.reader = false;
        self.unnoticed = true;
        match self.promise {
            Promise::Exact => self.messages.clear(),
            Promise::LostWithAPeer => self.doubt_all(),
        }
    }

    /// The sender was told whether a reader is there.
    pub(super) fn sender_learns(&mut self, present: bool) {
        self.unnoticed &= present;
    }

    pub(super) fn sender_goes(&mut self, flushed: bool) {
        if !self.promise.is_exact() && !flushed {
            self.doubt_all();
        }
        // The next sender starts afresh with whoever is there.
        self.unnoticed = false;
    }

    fn doubt_all(&mut self) {
        self.messages.iter_mut().for_each(|one| one.may_be_lost = true);
    }
}
