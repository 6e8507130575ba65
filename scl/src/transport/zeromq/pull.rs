//! The pulling end, which accepts any number of pushers: a PULL socket to them.

use super::TransportKind;
use super::acceptor::Acceptor;
use super::credit::receiving;
use super::inbound::Inbound;
use super::zmtp::SocketType;
use crate::runtime_dir::SystemDir;
use crate::transport::origins::Origins;
use crate::transport::{Endpoint, Receiver, TransportError};
use bytes::Bytes;
use std::collections::VecDeque;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

/// How many messages one pusher may deliver in a row while others may have some as well.
const IN_A_ROW: usize = 64;

pub(super) struct Puller {
    acceptor: Acceptor,
    endpoint: Endpoint,
    pushers: Vec<Pusher>,
    /// Number of pushers so far.
    accepted: u64,
    /// For an end whose caller acknowledges messages: the pushers of those that are not acknowledged, in order.
    untold: VecDeque<u64>,
    /// The pushers of the messages that wait in the gate.
    waiting: Origins,
    finishing: bool,
    /// The pusher whose turn it is, and how many messages it has delivered in it.
    turn: usize,
    delivered: usize,
    malformed: u64,
}

struct Pusher {
    number: u64,
    /// Number of its messages that wait in the gate.
    waiting: u64,
    inbound: Inbound,
}

impl Puller {
    pub(super) fn open(dir: &Arc<SystemDir>, kind: TransportKind, endpoint: &Endpoint) -> Result<Self, TransportError> {
        let acceptor = Acceptor::open(dir, kind, endpoint, SocketType::Pull, receiving(endpoint))?.offering_memory()?;
        let (pushers, untold, endpoint) = (Vec::new(), VecDeque::new(), endpoint.clone());
        Ok(Self {
            acceptor,
            endpoint,
            pushers,
            accepted: 0,
            untold,
            waiting: Origins::default(),
            finishing: false,
            turn: 0,
            delivered: 0,
            malformed: 0,
        })
    }

    fn accept(&mut self, cx: &mut Context<'_>) {
        while let Poll::Ready((session, ready)) = self.acceptor.poll_session(cx, self.pushers.len()) {
            let mut inbound = Inbound::new(session, &ready, &self.endpoint, self.acceptor.dir());
            if self.finishing {
                inbound.finish();
            }
            self.pushers.push(Pusher { number: self.accepted, waiting: 0, inbound });
            self.accepted += 1;
        }
    }

    /// Polls the pusher whose turn it is.
    fn poll_turn(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        while let Some(pusher) = self.pushers.get_mut(self.turn) {
            let next = pusher.inbound.poll_next(cx);
            self.malformed += pusher.inbound.take_malformed();
            match next {
                Poll::Ready(Ok(message)) => {
                    if self.endpoint.deferred.is_some() {
                        self.untold.push_back(pusher.number);
                    } else {
                        self.waiting.push(pusher.number);
                        pusher.waiting += 1;
                    }
                    return Poll::Ready(message);
                }
                Poll::Ready(Err(error)) => {
                    tracing::debug!(%error, "a pusher left");
                    self.pushers.remove(self.turn);
                }
                Poll::Pending => break,
            }
        }
        Poll::Pending
    }

    fn next_turn(&mut self) {
        self.turn = if self.turn + 1 < self.pushers.len() { self.turn + 1 } else { 0 };
        self.delivered = 0;
    }
}

impl Receiver for Puller {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        if self.delivered >= IN_A_ROW {
            self.next_turn();
            self.accept(cx);
        }
        for pass in 0..2 {
            for _ in 0..=self.pushers.len() {
                if let Poll::Ready(message) = self.poll_turn(cx) {
                    self.delivered += 1;
                    return Poll::Ready(message);
                }
                self.next_turn();
            }
            if pass == 0 {
                let before = self.pushers.len();
                self.accept(cx);
                // Those that were polled already will wake the task; the others must be polled as well.
                if self.pushers.len() == before {
                    break;
                }
            }
        }
        Poll::Pending
    }

    fn connect(&mut self, cx: &mut Context<'_>) {
        self.accept(cx);
    }

    fn peers(&self) -> usize {
        self.pushers.len()
    }

    fn is_lossless(&self) -> bool {
        self.pushers.iter().any(|pusher| pusher.inbound.is_lossless())
    }

    fn malformed(&self) -> u64 {
        self.malformed
    }

    fn acknowledge(&mut self, count: u64) {
        let count = self.untold.len().min(usize::try_from(count).unwrap_or(usize::MAX));
        for number in self.untold.drain(..count) {
            // One that has left counts its messages as lost.
            if let Some(pusher) = self.pushers.iter_mut().find(|pusher| pusher.number == number) {
                pusher.inbound.acknowledge_deferred(1);
            }
        }
    }

    fn note_waiting(&mut self, cx: &mut Context<'_>, waiting: u64) -> bool {
        let pushers = &mut self.pushers;
        self.waiting.keep_newest(waiting, |sender, count| {
            // One that has left counts its messages as lost.
            if let Some(pusher) = pushers.iter_mut().find(|pusher| pusher.number == sender) {
                pusher.waiting -= count;
            }
        });
        pushers.iter_mut().fold(false, |any, pusher| pusher.inbound.note_waiting(cx, pusher.waiting) | any)
    }

    fn note_dropped(&mut self) {
        let sender = self.waiting.drop_newest();
        if let Some(pusher) = self.pushers.iter_mut().find(|pusher| Some(pusher.number) == sender) {
            pusher.waiting -= 1;
        }
    }

    fn acknowledge_last(&mut self) {
        self.pushers.iter_mut().for_each(|pusher| pusher.inbound.acknowledge_last());
    }

    fn take_acknowledgement_request(&mut self) -> bool {
        let requested = self.pushers.iter_mut().map(|pusher| pusher.inbound.take_acknowledgement_request());
        requested.fold(false, |any, one| any | one)
    }

    fn finish(&mut self) {
        self.finishing = true;
        self.pushers.iter_mut().for_each(|pusher| pusher.inbound.finish());
    }

    fn is_finished(&self) -> bool {
        self.pushers.iter().all(|pusher| pusher.inbound.is_finished())
    }

    fn forget_answers(&mut self) {
        self.pushers.iter_mut().for_each(|pusher| pusher.inbound.forget_answer());
    }

    fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let mut caught_up = Poll::Ready(());
        for pusher in &mut self.pushers {
            if pusher.inbound.poll_caught_up(cx).is_pending() {
                caught_up = Poll::Pending;
            }
        }
        caught_up
    }

    fn catch_up(&mut self, within: Duration) {
        for pusher in &mut self.pushers {
            pusher.inbound.catch_up(within);
        }
    }
}
