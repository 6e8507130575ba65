//! The pulling end, which accepts any number of pushers: a PULL socket to them.

use super::TransportKind;
use super::acceptor::Acceptor;
use super::credit::receiving;
use super::inbound::Inbound;
use super::zmtp::SocketType;
use crate::runtime_dir::SystemDir;
use crate::transport::senders::Senders;
use crate::transport::{Endpoint, Receiver, TransportError};
use bytes::Bytes;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

/// How many messages one pusher may deliver before the next one gets its turn.
const IN_A_ROW: usize = 64;

pub(super) struct Puller {
    acceptor: Acceptor,
    /// If the caller acknowledges messages, those that are not acknowledged count as waiting.
    pushers: Senders<Inbound>,
    finishing: bool,
    malformed: u64,
    /// When the message returned last was sent, if its pusher has told.
    sent: Option<Instant>,
}

impl Puller {
    pub(super) fn open(dir: &Arc<SystemDir>, kind: TransportKind, endpoint: &Endpoint) -> Result<Self, TransportError> {
        let acceptor = Acceptor::open(dir, kind, endpoint, SocketType::Pull, receiving(endpoint))?.offering_memory()?;
        Ok(Self { acceptor, pushers: Senders::new(IN_A_ROW), finishing: false, malformed: 0, sent: None })
    }

    fn accept(&mut self, cx: &mut Context<'_>) {
        while let Poll::Ready((session, ready)) = self.acceptor.poll_session(cx, self.pushers.len()) {
            let mut inbound = Inbound::new(session, &ready, &self.acceptor.endpoint, &self.acceptor.dir);
            if self.finishing {
                inbound.finish();
            }
            self.pushers.add(inbound);
        }
    }
}

impl Receiver for Puller {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        if self.pushers.is_turn_over() {
            self.accept(cx);
        }
        loop {
            let (malformed, sent) = (&mut self.malformed, &mut self.sent);
            let polled = self.pushers.poll(|pusher| {
                let next = pusher.poll_next(cx);
                *malformed += pusher.take_malformed();
                *sent = pusher.take_sent();
                next.map(|next| next.inspect_err(|error| tracing::debug!(%error, "a pusher left")).ok())
            });
            if polled.is_ready() {
                return polled;
            }
            let before = self.pushers.len();
            self.accept(cx);
            // The connections polled above will wake the task, but new ones have to be polled first.
            if self.pushers.len() == before {
                return Poll::Pending;
            }
        }
    }

    fn connect(&mut self, cx: &mut Context<'_>) {
        self.accept(cx);
    }

    fn peers(&self) -> usize {
        self.pushers.len()
    }

    fn is_lossless(&self) -> bool {
        self.pushers.ends().any(Inbound::is_lossless)
    }

    fn take_sent(&mut self) -> Option<Instant> {
        self.sent.take()
    }

    fn malformed(&self) -> u64 {
        self.malformed
    }

    fn acknowledge(&mut self, count: u64) {
        let waiting = self.pushers.waiting().saturating_sub(count);
        self.pushers.keep_newest(waiting, Inbound::acknowledge_deferred);
    }

    fn note_waiting(&mut self, cx: &mut Context<'_>, waiting: u64) -> bool {
        if self.acceptor.endpoint.deferred.is_none() {
            self.pushers.keep_newest(waiting, |_, _| {});
        }
        let noted = self.pushers.ends_mut().map(|(pusher, waiting)| pusher.note_waiting(cx, waiting));
        noted.fold(false, |any, one| any | one)
    }

    fn note_dropped(&mut self) {
        self.pushers.drop_newest();
    }

    fn acknowledge_last(&mut self) {
        self.pushers.ends_mut().for_each(|(pusher, _)| pusher.acknowledge_last());
    }

    fn take_acknowledgement_request(&mut self) -> bool {
        let requested = self.pushers.ends_mut().map(|(pusher, _)| pusher.take_acknowledgement_request());
        requested.fold(false, |any, one| any | one)
    }

    fn finish(&mut self) {
        self.finishing = true;
        self.pushers.ends_mut().for_each(|(pusher, _)| pusher.finish());
    }

    fn is_finished(&self) -> bool {
        self.pushers.ends().all(Inbound::is_finished)
    }

    fn forget_answers(&mut self) {
        self.pushers.ends_mut().for_each(|(pusher, _)| pusher.forget_answer());
    }

    fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        // Every pusher is asked, even if an earlier one is behind.
        let pending = self.pushers.ends_mut().map(|(pusher, _)| pusher.poll_caught_up(cx).is_pending());
        if pending.fold(false, |any, one| any | one) { Poll::Pending } else { Poll::Ready(()) }
    }

    fn catch_up(&mut self, within: Duration) {
        self.pushers.ends_mut().for_each(|(pusher, _)| pusher.catch_up(within));
    }
}
