//! The connections of one sender together.

use super::held::Held;
use super::inbox::Inbox;
use super::layout::{Declared, Layout};
use super::message::Message;
use super::way::{Promise, Way};
use crate::trial::Outcome;
use scl::private::GateKind;

pub(super) struct Model {
    backpressure: bool,
    /// Whether each message goes to one of the readers only.
    shares: bool,
    /// Of a sender that shares, whose turn it is.
    turn: usize,
    /// The message that is being sent.
    sending: Option<Message>,
    /// Of a sender that shares, the reader that the message is for, as soon as that shows.
    chosen: Option<usize>,
    pub(super) connections: Vec<Connection>,
    /// The first thing that went wrong where nothing can be returned.
    broken: Outcome,
}

pub(super) struct Connection {
    declared: Declared,
    pub(super) held: Held,
    pub(super) way: Way,
    pub(super) inbox: Inbox,
}

/// How many messages the transport in memory holds for one reader.
const ON_THE_WAY: usize = 64;

impl Connection {
    /// Of a connection in memory, whether a message waits although the reader is there and has room for it.
    pub(super) fn could_take_more(&self) -> bool {
        !self.held.waiting.is_empty() && self.way.has_reader() && self.way.due() < ON_THE_WAY
    }
}

impl Model {
    pub(super) fn new(layout: &Layout, promise: Promise) -> Self {
        let connect = |declared: &Declared| Connection {
            declared: *declared,
            held: Held::new(*declared, layout.backpressure),
            way: Way::new(promise),
            inbox: Inbox::new(*declared),
        };
        Self {
            backpressure: layout.backpressure,
            shares: layout.kind == GateKind::Push && layout.readers().len() > 1,
            turn: 0,
            sending: None,
            chosen: None,
            connections: layout.readers().iter().map(connect).collect(),
            broken: Ok(()),
        }
    }

    /// What went wrong so far.
    pub(super) fn verdict(&self) -> Outcome {
        self.broken.clone()
    }

    fn note(&mut self, place: usize, outcome: Outcome) {
        if self.broken.is_ok() {
            self.broken = outcome.map_err(|reason| format!("reader {place}: {reason}"));
        }
    }

    /// Whether nothing has to arrive any more.
    pub(super) fn is_idle(&self) -> bool {
        let idle = |one: &Connection| one.held.waiting.is_empty() && one.way.due() == 0 && one.inbox.waiting.is_empty();
        self.connections.iter().all(idle)
    }

    /// Whether one more message would have to wait.
    pub(super) fn makes_wait(&self) -> bool {
        let mut waits = self.connections.iter().map(|connection| connection.held.makes_wait());
        if self.shares { waits.all(|waits| waits) } else { waits.any(|waits| waits) }
    }

    pub(super) fn begins(&mut self, message: Message) {
        (self.sending, self.chosen) = (Some(message), None);
        self.connections.iter_mut().for_each(|connection| connection.held.may_be_offered());
        if !self.shares {
            self.connections.iter_mut().for_each(|connection| connection.held.begins(message));
        }
    }

    pub(super) fn is_called_off(&mut self) {
        self.sending = None;
        self.connections.iter_mut().for_each(|connection| connection.held.is_called_off());
    }

    pub(super) fn ends(&mut self) {
        if self.shares {
            let chosen = self.choose();
            self.turn = chosen + 1;
        }
        self.sending = None;
        for place in 0..self.connections.len() {
            let ended = self.connections[place].held.ends();
            self.note(place, ended);
        }
    }

    /// Of a sender that shares: the next reader in turn that can take a message now, or else whose queue can, or else
    /// that declared to drop one.
    fn choose(&mut self) -> usize {
        let (turn, count) = (self.turn, self.connections.len());
        let next = |can: fn(&Held) -> bool| {
            (turn..turn + count).map(|place| place % count).find(|&place| can(&self.connections[place].held))
        };
        let with_room = || next(|held| !held.is_full()).or_else(|| next(|held| !held.makes_wait()));
        let next = next(Held::is_free).or_else(with_room).unwrap_or(turn % count);
        let chosen = *self.chosen.get_or_insert(next);
        if let Some(message) = self.sending.take() {
            self.connections[chosen].held.begins(message);
        }
        chosen
    }

    pub(super) fn offered(&mut self, place: usize, message: Message, taken: bool) {
        if self.shares && self.sending == Some(message) {
            self.choose();
        }
        let connection = &mut self.connections[place];
        let mut outcome = connection.held.offered(message, taken);
        if taken {
            outcome = outcome.and_then(|()| connection.way.takes(message));
        }
        self.note(place, outcome);
    }

    pub(super) fn arrives(&mut self, place: usize, message: Message) {
        let connection = &mut self.connections[place];
        let outcome = connection.way.arrives(message).and_then(|()| connection.inbox.arrives(message));
        self.note(place, outcome);
    }

    /// Something crossed the border that is no message.
    pub(super) fn is_no_message(&mut self, place: usize, reason: String) {
        self.note(place, Err(reason));
    }

    pub(super) fn sender_learns(&mut self, place: usize, present: bool) {
        let connection = &mut self.connections[place];
        connection.held.present = present;
        connection.held.has_its_turn();
        connection.way.sender_learns(present);
    }

    /// The sender vanishes, with what waits in its queues.
    pub(super) fn sender_goes(&mut self, flushed: bool) {
        (self.turn, self.sending) = (0, None);
        for connection in &mut self.connections {
            connection.held = Held::new(connection.declared, self.backpressure);
            connection.way.sender_goes(flushed);
        }
    }

    pub(super) fn reader_goes(&mut self, place: usize) {
        let connection = &mut self.connections[place];
        connection.inbox = Inbox::new(connection.declared);
        connection.way.reader_goes();
    }
}
