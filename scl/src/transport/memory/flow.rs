//! The roles that only send or only receive: publish, subscribe, push, pull.

use super::meeting::Present;
use super::pipe::{Receiver, Sender};
use crate::transport::{Inlet, Outlet};
use bytes::Bytes;
use std::task::{Context, Poll};

type AtPublisher<H> = Present<Sender<Bytes>, Receiver<Bytes>, H>;
type AtPuller<H> = Present<Receiver<Bytes>, Sender<Bytes>, H>;

pub(super) struct Publishing {
    subscribers: Vec<Sender<Bytes>>,
    present: AtPublisher<Sender<Bytes>>,
}

impl Publishing {
    pub(super) fn new(present: AtPublisher<Sender<Bytes>>) -> Self {
        Self { subscribers: Vec::new(), present }
    }
}

impl Outlet for Publishing {
    fn drive(&mut self, cx: &mut Context<'_>) -> bool {
        while let Poll::Ready(subscriber) = self.present.poll_connection(cx) {
            self.subscribers.push(subscriber);
        }
        self.subscribers.retain(|subscriber| subscriber.is_read(cx));
        !self.subscribers.is_empty()
    }

    /// Either every subscriber gets the message or none.
    fn offer(&mut self, cx: &mut Context<'_>, message: Bytes) -> Result<(), Bytes> {
        self.subscribers.retain(Sender::is_open);
        // All are asked, so that each one without room says when it has some; nobody but this end can fill it.
        let without_room = self.subscribers.iter().filter(|subscriber| !subscriber.has_room(cx)).count();
        if self.subscribers.is_empty() || without_room > 0 {
            return Err(message);
        }
        let taken = self.subscribers.iter().filter(|subscriber| subscriber.send(message.clone()).is_ok()).count();
        if taken > 0 { Ok(()) } else { Err(message) }
    }

    /// What was taken can be read even when this end is gone.
    fn is_flushed(&self) -> bool {
        true
    }
}

pub(super) struct Subscribing {
    publisher: Option<Receiver<Bytes>>,
    present: AtPublisher<Receiver<Bytes>>,
}

impl Subscribing {
    pub(super) fn new(present: AtPublisher<Receiver<Bytes>>) -> Self {
        Self { publisher: None, present }
    }
}

impl Inlet for Subscribing {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        loop {
            let Some(publisher) = &self.publisher else {
                match self.present.poll_connection(cx) {
                    Poll::Ready(publisher) => self.publisher = Some(publisher),
                    Poll::Pending => return Poll::Pending,
                }
                continue;
            };
            match publisher.poll_recv(cx) {
                Poll::Ready(Some(message)) => return Poll::Ready(message),
                Poll::Ready(None) => self.publisher = None,
                Poll::Pending => return Poll::Pending,
            }
        }
    }

    fn peers(&self) -> Option<usize> {
        let connected = self.publisher.as_ref().is_some_and(Receiver::is_open);
        Some(usize::from(connected || self.present.has_connection(Receiver::is_open)))
    }
}

pub(super) struct Pushing {
    puller: Option<Sender<Bytes>>,
    present: AtPuller<Sender<Bytes>>,
}

impl Pushing {
    pub(super) fn new(present: AtPuller<Sender<Bytes>>) -> Self {
        Self { puller: None, present }
    }
}

impl Outlet for Pushing {
    fn drive(&mut self, cx: &mut Context<'_>) -> bool {
        self.puller.take_if(|puller| !puller.is_read(cx));
        while self.puller.is_none()
            && let Poll::Ready(puller) = self.present.poll_connection(cx)
        {
            self.puller = Some(puller).filter(|puller| puller.is_read(cx));
        }
        self.puller.is_some()
    }

    fn offer(&mut self, cx: &mut Context<'_>, message: Bytes) -> Result<(), Bytes> {
        match &self.puller {
            Some(puller) if puller.has_room(cx) => puller.send(message),
            _ => Err(message),
        }
    }

    /// What was taken can be read even when this end is gone.
    fn is_flushed(&self) -> bool {
        true
    }
}

pub(super) struct Pulling {
    pushers: Vec<Receiver<Bytes>>,
    /// The pusher to ask first, so that none is kept waiting by another.
    next: usize,
    present: AtPuller<Receiver<Bytes>>,
}

impl Pulling {
    pub(super) fn new(present: AtPuller<Receiver<Bytes>>) -> Self {
        Self { pushers: Vec::new(), next: 0, present }
    }
}

impl Inlet for Pulling {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        while let Poll::Ready(pusher) = self.present.poll_connection(cx) {
            self.pushers.push(pusher);
        }
        let received = poll_in_turn(&mut self.pushers, &mut self.next, |pusher| pusher.poll_recv(cx));
        received.map_or(Poll::Pending, Poll::Ready)
    }

    fn peers(&self) -> Option<usize> {
        None
    }
}

/// Asks each connection once, from `next` on, until one has something; those that say `None` are over.
pub(super) fn poll_in_turn<H, M>(
    connections: &mut Vec<H>,
    next: &mut usize,
    mut poll: impl FnMut(&H) -> Poll<Option<M>>,
) -> Option<M> {
    let mut to_ask = connections.len();
    while to_ask > 0 {
        to_ask -= 1;
        *next = if *next < connections.len() { *next } else { 0 };
        match poll(&connections[*next]) {
            Poll::Ready(None) => drop(connections.remove(*next)),
            Poll::Ready(Some(message)) => {
                *next += 1;
                return Some(message);
            }
            Poll::Pending => *next += 1,
        }
    }
    None
}
