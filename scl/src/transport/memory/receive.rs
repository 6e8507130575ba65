//! The receiving ends: subscribe and pull.

use super::catch_up::catch_up;
use super::pipe::{PipeReader, PipeWriter};
use super::round_robin::RoundRobin;
use super::switchboard::{Connector, Listener};
use crate::transport::{Endpoint, Receiver};
use bytes::Bytes;
use std::collections::VecDeque;
use std::task::{Context, Poll, ready};
use std::time::Duration;

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

    fn is_lossless(&self) -> bool {
        self.publisher.as_ref().is_some_and(|publisher| publisher.is_open() && publisher.is_lossless())
    }

    fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let Some(publisher) = &self.publisher else { return Poll::Ready(()) };
        if !publisher.poll_caught_up(cx) {
            return Poll::Pending;
        }
        publisher.forget_answer();
        Poll::Ready(())
    }

    fn catch_up(&mut self, within: Duration) {
        if self.inbound.newest_only {
            // An answer to an earlier call, or one that comes after this call has given up, may be old when it is used.
            self.publisher.iter().for_each(PipeReader::forget_answer);
            self.inbound.fetched = catch_up(self, within);
            self.publisher.iter().for_each(PipeReader::forget_answer);
        }
    }

    fn refusal(&self) -> Option<String> {
        self.connector.refusal()
    }
}

pub(super) struct Puller {
    listener: Listener<PipeReader<Bytes>, PipeWriter<Bytes>>,
    pushers: RoundRobin<PipeReader<Bytes>>,
    inbound: Inbound,
}

impl Puller {
    pub(super) fn new(listener: Listener<PipeReader<Bytes>, PipeWriter<Bytes>>, endpoint: &Endpoint) -> Self {
        Self { listener, pushers: RoundRobin::new(), inbound: Inbound::new(endpoint) }
    }
}

impl Receiver for Puller {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        if let Some(message) = self.inbound.fetched.pop_front() {
            return Poll::Ready(message);
        }
        while let Poll::Ready(pusher) = self.listener.poll_connection(cx) {
            self.pushers.add(pusher);
        }
        let max_size = self.inbound.max_size;
        self.pushers.poll(|pusher| {
            let received = pusher.poll_recv(cx);
            // Without a message, the pusher is removed and thereby disconnected.
            received.map(|message| message.filter(|message| message.len() <= max_size))
        })
    }

    fn peers(&self) -> usize {
        let open = self.pushers.iter().filter(|pusher| pusher.is_open()).count();
        open + self.listener.count(PipeReader::is_open)
    }

    fn is_lossless(&self) -> bool {
        self.pushers.iter().any(|pusher| pusher.is_open() && pusher.is_lossless())
    }

    fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        // All are asked before any of the answers is used up.
        let behind = self.pushers.iter().filter(|pusher| !pusher.poll_caught_up(cx)).count();
        if behind > 0 {
            return Poll::Pending;
        }
        self.pushers.iter().for_each(PipeReader::forget_answer);
        Poll::Ready(())
    }

    fn catch_up(&mut self, within: Duration) {
        if self.inbound.newest_only {
            // An answer to an earlier call, or one that comes after this call has given up, may be old when it is used.
            self.pushers.iter().for_each(PipeReader::forget_answer);
            self.inbound.fetched = catch_up(self, within);
            self.pushers.iter().for_each(PipeReader::forget_answer);
        }
    }
}
