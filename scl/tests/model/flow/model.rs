//! The connections of one sender together.

use super::inbox::{Call, Inbox};
use super::layout::{Declared, Layout};
use super::message::Message;
use super::outbox::Outbox;
use super::transit::{Promise, Transit};
use crate::model::runner::Outcome;
use scl::private::GateKind;

pub(super) struct Model {
    promise: Promise,
    backpressure: bool,
    /// Whether each message goes to one of the readers only.
    shares: bool,
    /// The reader whose turn it is, if the sender shares.
    turn: usize,
    /// Number of the present sender, or of the last one.
    sender: u32,
    sender_is_gone: bool,
    /// The message that is being sent.
    sending: Option<Message>,
    /// If the sender shares: the reader that gets the message, as soon as that is known.
    chosen: Option<usize>,
    pub(super) connections: Vec<Connection>,
    /// The first contradiction in a place where nothing can be returned.
    broken: Outcome,
}

pub(super) struct Connection {
    declared: Declared,
    pub(super) outbox: Outbox,
    pub(super) transit: Transit,
    pub(super) inbox: Inbox,
    /// What the open link counted when it was last asked: messages that the reader's program has not received.
    pub(super) not_received: u64,
    /// What the sender's account has counted as taken, which never falls.
    pub(super) taken: u64,
}

/// How many messages the memory transport holds for one reader.
const IN_FLIGHT: usize = 64;

impl Connection {
    /// Of a connection in memory: returns true if the reader is there, and has room for everything that waits.
    pub(super) fn has_room_for_all(&self) -> bool {
        let room = if self.inbox.is_newest_only() { 1 } else { IN_FLIGHT };
        self.transit.has_reader() && self.transit.due() + self.outbox.waiting.len() <= room
    }

    fn call_begins(&mut self, call: Call) {
        self.inbox.begins(call, self.held_back());
    }

    /// The newest message that the sender could not hand over.
    fn held_back(&self) -> Option<Message> {
        self.outbox.waiting.back().filter(|_| self.outbox.holds_back).copied()
    }

    /// A receiving call is done. One that waits must not return an old message to a reader that wants the newest.
    pub(super) fn call_ends(&mut self, given: Option<Message>) -> Outcome {
        if let (Some(message), Some(owed), Some(held)) = (given, self.inbox.owed(), self.held_back())
            && self.transit.promise().is_exact()
            && (message < owed && owed.sender == held.sender)
        {
            return Err(format!("the reader was given {message:?}, but its sender had {owed:?} when it first called"));
        }
        self.inbox.ends(given, self.outbox.holds_back || !self.transit.promise().is_exact())
    }
}

impl Model {
    pub(super) fn new(layout: &Layout, promise: Promise) -> Self {
        let connect = |declared: &Declared| Connection {
            declared: *declared,
            outbox: Outbox::new(*declared, layout.backpressure),
            transit: Transit::new(promise),
            inbox: Inbox::new(*declared),
            not_received: 0,
            taken: 0,
        };
        Self {
            promise,
            backpressure: layout.backpressure,
            shares: layout.kind == GateKind::Push && layout.readers().len() > 1,
            turn: 0,
            sender: 0,
            sender_is_gone: false,
            sending: None,
            chosen: None,
            connections: layout.readers().iter().map(connect).collect(),
            broken: Ok(()),
        }
    }

    /// The first contradiction so far.
    pub(super) fn verdict(&self) -> Outcome {
        self.broken.clone()
    }

    fn note(&mut self, reader: usize, outcome: Outcome) {
        if self.broken.is_ok() {
            self.broken = outcome.map_err(|reason| format!("reader {reader}: {reason}"));
        }
    }

    /// Returns true if nothing has to arrive any more.
    pub(super) fn is_idle(&self) -> bool {
        let idle =
            |one: &Connection| one.outbox.waiting.is_empty() && one.transit.due() == 0 && one.inbox.waiting.is_empty();
        self.connections.iter().all(idle)
    }

    /// Returns true if one more message would have to wait.
    pub(super) fn would_wait(&self) -> bool {
        let mut waits = self.connections.iter().map(|connection| connection.outbox.would_wait());
        if self.shares { waits.all(|waits| waits) } else { waits.any(|waits| waits) }
    }

    pub(super) fn begins(&mut self, message: Message) {
        (self.sending, self.chosen) = (Some(message), None);
        self.connections.iter_mut().for_each(|connection| connection.outbox.call_begins());
        if !self.shares {
            self.connections.iter_mut().for_each(|connection| connection.outbox.begins(message));
        }
    }

    pub(super) fn is_cancelled(&mut self) {
        self.sending = None;
        self.connections.iter_mut().for_each(|connection| connection.outbox.is_cancelled());
    }

    pub(super) fn ends(&mut self) {
        if self.shares {
            let chosen = self.choose();
            self.turn = chosen + 1;
        }
        self.sending = None;
        for reader in 0..self.connections.len() {
            let ended = self.connections[reader].outbox.ends();
            self.note(reader, ended);
        }
    }

    /// If the sender shares: the next reader in turn that can take a message now, or else whose queue can, or else that
    /// declared to drop one.
    fn choose(&mut self) -> usize {
        let (turn, count) = (self.turn, self.connections.len());
        let next = |can: fn(&Outbox) -> bool| {
            (turn..turn + count).map(|reader| reader % count).find(|&reader| can(&self.connections[reader].outbox))
        };
        let with_room = || next(|outbox| !outbox.is_full()).or_else(|| next(|outbox| !outbox.would_wait()));
        let next = next(Outbox::is_free).or_else(with_room).unwrap_or(turn % count);
        let chosen = *self.chosen.get_or_insert(next);
        if let Some(message) = self.sending.take() {
            self.connections[chosen].outbox.begins(message);
        }
        chosen
    }

    pub(super) fn offered(&mut self, reader: usize, message: Message, accepted: bool) {
        if self.shares && self.sending == Some(message) {
            self.choose();
        }
        let connection = &mut self.connections[reader];
        let mut outcome = connection.outbox.offered(message, accepted);
        if accepted {
            outcome = outcome.and_then(|()| connection.transit.accepts(message));
        }
        self.note(reader, outcome);
    }

    pub(super) fn is_emptied(&mut self, reader: usize) {
        let outcome = self.connections[reader].outbox.is_emptied();
        self.note(reader, outcome);
    }

    pub(super) fn arrives(&mut self, reader: usize, message: Message) {
        let connection = &mut self.connections[reader];
        let outcome = connection.transit.arrives(message).and_then(|()| connection.inbox.arrives(message));
        self.note(reader, outcome);
    }

    /// A frame that no message has.
    pub(super) fn is_no_message(&mut self, reader: usize, reason: String) {
        self.note(reader, Err(reason));
    }

    /// Returns the number of the sender that the link belongs to.
    pub(super) fn link_opens(&mut self, reader: usize) -> u32 {
        let connection = &mut self.connections[reader];
        connection.outbox.link_opens();
        connection.transit.link_opens();
        self.sender
    }

    pub(super) fn link_closes(&mut self, reader: usize, sender: u32, unacknowledged: u64, not_received: u64) {
        if self.sender_is_gone || sender != self.sender {
            return;
        }
        self.unacknowledged(reader, unacknowledged);
        self.not_received(reader, not_received);
        let connection = &mut self.connections[reader];
        connection.outbox.link_closes(not_received);
        connection.transit.link_closes();
        connection.not_received = 0;
    }

    /// A link was asked how many messages its peer has not acknowledged.
    pub(super) fn unacknowledged(&mut self, reader: usize, counted: u64) {
        let connection = &mut self.connections[reader];
        let expected = connection.transit.unacknowledged(self.sender) as u64;
        if self.promise.is_exact() && counted != expected {
            self.note(reader, Err(format!("{counted} messages are unacknowledged instead of {expected}")));
        }
    }

    /// A link was asked how many messages the reader's program has not received. A message that was given to the
    /// program is never among them once its gate has told that, and one that it was not given always is.
    pub(super) fn not_received(&mut self, reader: usize, counted: u64) {
        let connection = &mut self.connections[reader];
        connection.not_received = counted;
        let stranded = connection.transit.unacknowledged(self.sender) as u64;
        let least = stranded + connection.inbox.waiting_of(self.sender);
        if self.promise.is_exact() && connection.transit.has_reader() && counted < least {
            self.note(reader, Err(format!("{counted} messages are not received instead of at least {least}")));
        }
    }

    pub(super) fn sender_appears(&mut self, sender: u32) {
        (self.sender, self.sender_is_gone) = (sender, false);
    }

    /// The sender vanishes, with what waits in its queues.
    pub(super) fn sender_vanishes(&mut self, flushed: bool) {
        (self.turn, self.sending, self.sender_is_gone) = (0, None, true);
        for connection in &mut self.connections {
            connection.outbox = Outbox::new(connection.declared, self.backpressure);
            connection.transit.sender_vanishes(flushed);
            (connection.not_received, connection.taken) = (0, 0);
        }
    }

    pub(super) fn reader_appears(&mut self, reader: usize) {
        self.connections[reader].transit.reader_appears();
    }

    pub(super) fn reader_vanishes(&mut self, reader: usize) {
        let sender = (!self.sender_is_gone).then_some(self.sender);
        let connection = &mut self.connections[reader];
        connection.inbox = Inbox::new(connection.declared);
        connection.transit.reader_vanishes(sender);
    }

    pub(super) fn call_begins(&mut self, reader: usize, call: Call) {
        self.connections[reader].call_begins(call);
    }
}
