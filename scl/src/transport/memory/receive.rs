//! The receiving ends: subscribe and pull.

use super::catch_up::catch_up;
use super::pipe::{PipeReader, PipeWriter};
use super::switchboard::{Connector, Listener};
use crate::transport::origins::Origins;
use crate::transport::round_robin::RoundRobin;
use crate::transport::{Endpoint, Receiver};
use bytes::Bytes;
use std::collections::VecDeque;
use std::task::{Context, Poll, ready};
use std::time::{Duration, Instant};

pub(super) struct Subscriber {
    connector: Connector<PipeWriter<Bytes>, PipeReader<Bytes>>,
    publisher: Option<PipeReader<Bytes>>,
    inbound: Inbound,
}

/// What both receiving ends know beside their connections.
struct Inbound {
    max_size: usize,
    newest_only: bool,
    /// Messages received by [`Receiver::catch_up`], which come before those of the connections.
    fetched: VecDeque<Bytes>,
}

impl Inbound {
    fn new(endpoint: &Endpoint) -> Self {
        Self { max_size: endpoint.max_size, newest_only: endpoint.newest_only, fetched: VecDeque::new() }
    }
}

impl Subscriber {
    pub(super) fn new(connector: Connector<PipeWriter<Bytes>, PipeReader<Bytes>>, endpoint: &Endpoint) -> Self {
        Self { connector, publisher: None, inbound: Inbound::new(endpoint) }
    }
}

impl Receiver for Subscriber {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        if let Some(message) = self.inbound.fetched.pop_front() {
            return Poll::Ready(message);
        }
        loop {
            let Some(publisher) = &self.publisher else {
                self.publisher = Some(ready!(self.connector.poll_connection(cx)));
                continue;
            };
            match ready!(publisher.poll_recv(cx)) {
                Some(message) if message.len() <= self.inbound.max_size => return Poll::Ready(message),
                Some(_too_long) => {
                    self.publisher = None;
                    self.connector.connect_again();
                }
                // A publisher that has dropped the connection and still listens has replaced this end by another.
                None => self.publisher = None,
            }
        }
    }

    fn peers(&self) -> usize {
        let is_connected = self.publisher.as_ref().is_some_and(PipeReader::is_open);
        usize::from(is_connected || self.connector.has_connection(PipeReader::is_open))
    }

    fn is_latched(&self) -> bool {
        self.publisher.as_ref().is_some_and(PipeReader::is_latched)
    }

    fn take_latched(&mut self) -> Option<Instant> {
        self.publisher.as_ref()?.latched(self.inbound.fetched.len() as u64)
    }

    fn note_waiting(&mut self, _: &mut Context<'_>, waiting: u64) -> bool {
        if let Some(publisher) = &self.publisher {
            publisher.note_waiting(waiting + self.inbound.fetched.len() as u64);
        }
        // Its sender looks at the number whenever it wants to.
        true
    }

    fn is_lossless(&self) -> bool {
        self.publisher.as_ref().is_some_and(|publisher| publisher.is_open() && publisher.is_lossless())
    }

    fn forget_answers(&mut self) {
        self.publisher.iter().for_each(PipeReader::forget_answer);
    }

    fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let is_behind = self.publisher.as_ref().is_some_and(|publisher| !publisher.poll_caught_up(cx));
        if is_behind { Poll::Pending } else { Poll::Ready(()) }
    }

    fn catch_up(&mut self, within: Duration) {
        if self.inbound.newest_only {
            self.inbound.fetched = catch_up(self, within);
        }
    }

    fn refusal(&self) -> Option<String> {
        self.connector.refusal()
    }
}

pub(super) struct Puller {
    listener: Listener<PipeReader<Bytes>, PipeWriter<Bytes>>,
    pushers: RoundRobin<Pusher>,
    /// Number of pushers so far.
    accepted: u64,
    /// The pushers of the messages that wait in the gate.
    waiting: Origins,
    inbound: Inbound,
}

struct Pusher {
    number: u64,
    /// Number of its messages that wait in the gate.
    waiting: u64,
    pipe: PipeReader<Bytes>,
}

impl Puller {
    pub(super) fn new(listener: Listener<PipeReader<Bytes>, PipeWriter<Bytes>>, endpoint: &Endpoint) -> Self {
        let (pushers, waiting, inbound) = (RoundRobin::new(), Origins::default(), Inbound::new(endpoint));
        Self { listener, pushers, accepted: 0, waiting, inbound }
    }
}

impl Receiver for Puller {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        if let Some(message) = self.inbound.fetched.pop_front() {
            return Poll::Ready(message);
        }
        while let Poll::Ready(pipe) = self.listener.poll_connection(cx) {
            self.pushers.connections.push(Pusher { number: self.accepted, waiting: 0, pipe });
            self.accepted += 1;
        }
        let (max_size, waiting) = (self.inbound.max_size, &mut self.waiting);
        self.pushers.poll(|pusher| {
            // Without a message, the pusher is removed and thereby disconnected.
            pusher.pipe.poll_recv(cx).map(|message| {
                let message = message.filter(|message| message.len() <= max_size)?;
                waiting.push(pusher.number);
                pusher.waiting += 1;
                Some(message)
            })
        })
    }

    fn peers(&self) -> usize {
        let open = self.pushers.connections.iter().filter(|pusher| pusher.pipe.is_open()).count();
        open + self.listener.count(PipeReader::is_open)
    }

    fn note_waiting(&mut self, _: &mut Context<'_>, waiting: u64) -> bool {
        let pushers = &mut self.pushers.connections;
        self.waiting.keep_newest(waiting + self.inbound.fetched.len() as u64, |sender, count| {
            if let Some(pusher) = pushers.iter_mut().find(|pusher| pusher.number == sender) {
                pusher.waiting -= count;
            }
        });
        self.pushers.connections.iter().for_each(|pusher| pusher.pipe.note_waiting(pusher.waiting));
        true
    }

    fn note_dropped(&mut self) {
        let sender = self.waiting.drop_newest();
        if let Some(pusher) = self.pushers.connections.iter_mut().find(|pusher| Some(pusher.number) == sender) {
            pusher.waiting -= 1;
        }
    }

    fn is_lossless(&self) -> bool {
        self.pushers.connections.iter().any(|pusher| pusher.pipe.is_open() && pusher.pipe.is_lossless())
    }

    fn forget_answers(&mut self) {
        self.pushers.connections.iter().for_each(|pusher| pusher.pipe.forget_answer());
    }

    fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        // Every pusher is asked, even if an earlier one is behind.
        let behind = self.pushers.connections.iter().filter(|pusher| !pusher.pipe.poll_caught_up(cx)).count();
        if behind > 0 { Poll::Pending } else { Poll::Ready(()) }
    }

    fn catch_up(&mut self, within: Duration) {
        if self.inbound.newest_only {
            self.inbound.fetched = catch_up(self, within);
        }
    }
}
