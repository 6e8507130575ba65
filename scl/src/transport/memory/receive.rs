//! The receiving ends: subscribe and pull.

use super::catch_up::catch_up;
use super::pipe::{PipeReader, PipeWriter};
use super::switchboard::{Connector, Listener};
use crate::transport::Receiver;
use crate::transport::senders::Senders;
use bytes::Bytes;
use std::collections::VecDeque;
use std::task::{Context, Poll, ready};
use std::time::{Duration, Instant};

pub(super) struct Subscriber {
    connector: Connector<PipeWriter<Bytes>, PipeReader<Bytes>>,
    publisher: Option<PipeReader<Bytes>>,
    /// Messages received by [`Receiver::catch_up`], which come before those of the connection.
    fetched: VecDeque<Bytes>,
}

impl Subscriber {
    pub(super) fn new(connector: Connector<PipeWriter<Bytes>, PipeReader<Bytes>>) -> Self {
        Self { connector, publisher: None, fetched: VecDeque::new() }
    }
}

impl Receiver for Subscriber {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        if let Some(message) = self.fetched.pop_front() {
            return Poll::Ready(message);
        }
        loop {
            let Some(publisher) = &self.publisher else {
                self.publisher = Some(ready!(self.connector.poll_connection(cx)));
                continue;
            };
            match ready!(publisher.poll_recv(cx)) {
                Some(message) if message.len() <= self.connector.endpoint.max_size => return Poll::Ready(message),
                Some(_too_long) => {
                    self.publisher = None;
                    self.connector.connect_again();
                }
                // Do not connect to this publisher again: if it still listens, it has replaced this end by another.
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
        self.publisher.as_ref()?.latched(self.fetched.len() as u64)
    }

    fn take_sent(&mut self) -> Option<Instant> {
        self.publisher.as_ref()?.sent(self.fetched.len() as u64)
    }

    fn note_waiting(&mut self, _: &mut Context<'_>, waiting: u64) -> bool {
        if let Some(publisher) = &self.publisher {
            publisher.note_waiting(waiting + self.fetched.len() as u64);
        }
        // Always true: the sender never asks for the number, but reads it whenever it needs it.
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
        if self.connector.endpoint.newest_only {
            self.fetched = catch_up(self, within);
        }
    }

    fn refusal(&self) -> Option<String> {
        self.connector.refusal()
    }
}

pub(super) struct Puller {
    listener: Listener<PipeReader<Bytes>, PipeWriter<Bytes>>,
    pushers: Senders<PipeReader<Bytes>>,
    /// As in a [`Subscriber`].
    fetched: VecDeque<Bytes>,
    /// When the message read last was sent, if its pusher has told.
    sent: Option<Instant>,
}

impl Puller {
    pub(super) fn new(listener: Listener<PipeReader<Bytes>, PipeWriter<Bytes>>) -> Self {
        Self { listener, pushers: Senders::new(1), fetched: VecDeque::new(), sent: None }
    }
}

impl Receiver for Puller {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        if let Some(message) = self.fetched.pop_front() {
            return Poll::Ready(message);
        }
        while let Poll::Ready(pusher) = self.listener.poll_connection(cx) {
            self.pushers.add(pusher);
        }
        let max_size = self.listener.endpoint.max_size;
        // Returning `None` removes the pusher and thereby disconnects it.
        let sent = &mut self.sent;
        self.pushers.poll(|pusher| {
            let polled = pusher.poll_recv(cx).map(|message| message.filter(|it| it.len() <= max_size));
            if polled.is_ready() {
                *sent = pusher.sent(0);
            }
            polled
        })
    }

    fn take_sent(&mut self) -> Option<Instant> {
        // Of the messages read ahead, only the newest reaches the program.
        if self.fetched.is_empty() { self.sent.take() } else { None }
    }

    fn peers(&self) -> usize {
        self.pushers.ends().filter(|pusher| pusher.is_open()).count() + self.listener.count(PipeReader::is_open)
    }

    fn note_waiting(&mut self, _: &mut Context<'_>, waiting: u64) -> bool {
        self.pushers.keep_newest(waiting + self.fetched.len() as u64, |_, _| {});
        self.pushers.ends_mut().for_each(|(pusher, waiting)| pusher.note_waiting(waiting));
        true
    }

    fn note_dropped(&mut self) {
        self.pushers.drop_newest();
    }

    fn is_lossless(&self) -> bool {
        self.pushers.ends().any(|pusher| pusher.is_open() && pusher.is_lossless())
    }

    fn forget_answers(&mut self) {
        self.pushers.ends().for_each(PipeReader::forget_answer);
    }

    fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        // Every pusher is asked, even if an earlier one is behind.
        let behind = self.pushers.ends().filter(|pusher| !pusher.poll_caught_up(cx)).count();
        if behind > 0 { Poll::Pending } else { Poll::Ready(()) }
    }

    fn catch_up(&mut self, within: Duration) {
        if self.listener.endpoint.newest_only {
            self.fetched = catch_up(self, within);
        }
    }
}
