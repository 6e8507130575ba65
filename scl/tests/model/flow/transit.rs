//! Model of what the transport has accepted and not delivered.

use super::message::Message;
use crate::model::runner::Outcome;
use std::collections::VecDeque;

/// What may be lost in transit, declared by nobody.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Promise {
    /// An accepted message arrives, unless the reader vanishes first; nothing is accepted for a reader that has
    /// vanished.
    Exact,
    /// `docs/zeromq.md`: an accepted message may be lost with the end that vanishes. If that is the reader, so may be
    /// those accepted until the sender notices; once a message arrives at the next reader, nothing is lost any more. A
    /// sender that was flushed before it vanished loses nothing.
    LostWithAPeer,
}

impl Promise {
    pub(super) fn is_exact(self) -> bool {
        self == Self::Exact
    }
}

pub(super) struct Transit {
    promise: Promise,
    messages: VecDeque<InTransit>,
    reader: bool,
    /// Whether a reader vanished and the sender may not have noticed.
    unnoticed: bool,
    /// Number of messages of the open link that its reader took with it.
    stranded: usize,
}

struct InTransit {
    message: Message,
    may_be_lost: bool,
}

impl Transit {
    pub(super) fn new(promise: Promise) -> Self {
        Self { promise, messages: VecDeque::new(), reader: false, unnoticed: false, stranded: 0 }
    }

    pub(super) fn promise(&self) -> Promise {
        self.promise
    }

    pub(super) fn has_reader(&self) -> bool {
        self.reader
    }

    /// Number of messages that must still arrive.
    pub(super) fn due(&self) -> usize {
        self.messages.iter().filter(|one| !one.may_be_lost).count()
    }

    /// With [`Promise::Exact`], number of messages that a sender's link must count as unacknowledged.
    pub(super) fn unacknowledged(&self, sender: u32) -> usize {
        self.messages.iter().filter(|one| one.message.sender == sender).count() + self.stranded
    }

    pub(super) fn accepts(&mut self, message: Message) -> Outcome {
        let exact = self.promise.is_exact();
        if exact && !self.reader {
            return Err(format!("{message:?} was accepted for nobody"));
        }
        self.messages.push_back(InTransit { message, may_be_lost: !exact && (self.unnoticed || !self.reader) });
        Ok(())
    }

    /// A message arrived. It must be the next one of its sender, whatever another sender sent before it vanished.
    pub(super) fn arrives(&mut self, message: Message) -> Outcome {
        let lost = |one: &InTransit| one.message.sender == message.sender && one.may_be_lost && one.message < message;
        self.messages.retain(|one| !lost(one));
        let next = self.messages.iter().position(|one| one.message.sender == message.sender);
        let Some(next) = next.and_then(|index| self.messages.remove(index)) else {
            return Err(format!("{message:?} arrived a second time, or at a reader that it was not sent to"));
        };
        if next.message != message {
            return Err(format!("{message:?} arrived before {:?}", next.message));
        }
        self.unnoticed = false;
        Ok(())
    }

    pub(super) fn reader_appears(&mut self) {
        self.reader = true;
    }

    /// The reader vanishes, with what it has not taken. `sender`: the one that has a link to it, if any.
    pub(super) fn reader_vanishes(&mut self, sender: Option<u32>) {
        self.reader = false;
        self.unnoticed = true;
        if self.promise.is_exact() {
            self.stranded = sender.map_or(0, |sender| self.unacknowledged(sender));
            self.messages.clear();
        } else {
            self.doubt_all();
        }
    }

    pub(super) fn link_opens(&mut self) {
        self.unnoticed &= !self.promise.is_exact();
    }

    pub(super) fn link_closes(&mut self) {
        (self.stranded, self.unnoticed) = (0, false);
    }

    pub(super) fn sender_vanishes(&mut self, flushed: bool) {
        if !self.promise.is_exact() && !flushed {
            self.doubt_all();
        }
        // The next sender begins with the reader that is there.
        (self.stranded, self.unnoticed) = (0, false);
    }

    fn doubt_all(&mut self) {
        self.messages.iter_mut().for_each(|one| one.may_be_lost = true);
    }
}
