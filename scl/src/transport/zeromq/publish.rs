//! The publishing end of one connection.
//!
//! This is the one role for which the library's socket is not used. Its XPUB tells nobody that a subscriber left and
//! then sends to nobody with success, writes each message by itself, however many wait, and closes the connection of a
//! subscriber that sends a heartbeat. So this end accepts its subscribers itself and speaks ZMTP with them.
//!
//! A message is written from the caller. What waits in the connection's queue is written many messages at a time.

use super::Medium;
use super::door::Door;
use super::listen::bind;
use super::stream::Acceptor;
use super::subscriber::Subscriber;
use super::zmtp::Header;
use crate::place::{Claim, SystemDir};
use crate::transport::{Outlet, TransportError};
use bytes::{BufMut, Bytes, BytesMut};
use std::collections::VecDeque;
use std::io;
use std::task::{Context, Poll};

/// How many bytes of messages are written together at most; a longer message is written by itself.
const TOGETHER: usize = 64 * 1024;
/// How many connections may be there that have not said who they are; the oldest give way.
const STRANGERS: usize = 64;

pub(super) struct Publishing {
    acceptor: Acceptor,
    door: Door,
    subscribers: Vec<Subscriber>,
    /// Memory for messages that are written together.
    together: BytesMut,
    _guard: Claim,
}

impl Publishing {
    pub(super) fn open(place: &SystemDir, medium: Medium, endpoint: &str) -> Result<Self, TransportError> {
        let refused =
            |error: io::Error| TransportError::Refused { endpoint: endpoint.to_owned(), reason: error.to_string() };
        let (listener, guard) = bind(place, medium, endpoint)?;
        let door = Door::of(&listener).map_err(refused)?;
        let acceptor = Acceptor::of(listener).map_err(refused)?;
        Ok(Self { acceptor, door, subscribers: Vec::new(), together: BytesMut::new(), _guard: guard })
    }

    fn accept(&mut self, cx: &mut Context<'_>) {
        while let Poll::Ready(accepted) = self.acceptor.poll_accept(cx) {
            match accepted {
                Ok(stream) => self.subscribers.push(Subscriber::of(stream)),
                Err(error) => {
                    tracing::debug!(%error, "a subscriber could not be accepted");
                    if self.door.refused(&error) {
                        // Who has not said who it is may have to come again.
                        self.subscribers.retain(Subscriber::is_ready);
                        break;
                    }
                }
            }
        }
        self.door.keep(cx);
        let mut strangers = self.subscribers.iter().filter(|one| !one.is_ready()).count();
        self.subscribers.retain(|one| {
            let gives_way = !one.is_ready() && strangers > STRANGERS;
            strangers -= usize::from(gives_way);
            !gives_way
        });
    }

    /// Does something with each subscriber, and parts with those that are gone.
    fn with_each(&mut self, mut act: impl FnMut(&mut Subscriber) -> io::Result<()>) {
        self.subscribers.retain_mut(|subscriber| match act(subscriber) {
            Ok(()) => true,
            Err(error) => {
                tracing::debug!(%error, "a subscriber left");
                false
            }
        });
    }

    /// Whether anybody is there who takes messages, and everybody who does takes more.
    fn is_free(&self) -> bool {
        self.is_anybody() && self.is_flushed()
    }

    fn is_anybody(&self) -> bool {
        self.subscribers.iter().any(Subscriber::is_subscribed)
    }

    /// Encodes messages from the front of a queue, as many as are written together, if there are several and everybody
    /// wants all of them; how many they are.
    fn gather(&mut self, queue: &VecDeque<Bytes>) -> Option<(usize, Bytes)> {
        let mut subscribed = self.subscribers.iter().filter(|one| one.is_subscribed());
        if queue.len() < 2 || !subscribed.all(Subscriber::wants_all) {
            return None;
        }
        self.together.reserve(TOGETHER);
        let mut count = 0;
        for message in queue {
            let header = Header::of(message);
            if self.together.len() + header.as_bytes().len() + message.len() > TOGETHER {
                break;
            }
            self.together.put_slice(header.as_bytes());
            self.together.put_slice(message);
            count += 1;
        }
        let frames = self.together.split().freeze();
        (count > 1).then_some((count, frames))
    }
}

impl Outlet for Publishing {
    fn drive(&mut self, cx: &mut Context<'_>) -> bool {
        self.accept(cx);
        self.with_each(|subscriber| subscriber.drive(cx));
        self.is_anybody()
    }

    fn offer(&mut self, cx: &mut Context<'_>, message: Bytes) -> Result<(), Bytes> {
        if !self.is_free() {
            return Err(message);
        }
        let before = self.subscribers.len();
        self.with_each(|subscriber| match subscriber.wants(&message) {
            true => subscriber.write_message(cx, &message),
            false => Ok(()),
        });
        if self.subscribers.len() == before {
            return Ok(());
        }
        // The task tells who is left; with nobody, the message waits for the next.
        cx.waker().wake_by_ref();
        if self.is_anybody() { Ok(()) } else { Err(message) }
    }

    fn offer_all(&mut self, cx: &mut Context<'_>, queue: &mut VecDeque<Bytes>, taken: &mut dyn FnMut(usize)) {
        while self.is_free() && !queue.is_empty() {
            let Some((count, frames)) = self.gather(queue) else {
                let Some(message) = queue.pop_front() else { return };
                let length = message.len();
                match self.offer(cx, message) {
                    Ok(()) => taken(length),
                    Err(message) => return queue.push_front(message),
                }
                continue;
            };
            self.with_each(|subscriber| match subscriber.is_subscribed() {
                true => subscriber.write_frames(cx, frames.clone()),
                false => Ok(()),
            });
            if !self.is_anybody() {
                // Whoever comes next gets them.
                return cx.waker().wake_by_ref();
            }
            queue.drain(..count).for_each(|message| taken(message.len()));
        }
    }

    fn is_flushed(&self) -> bool {
        self.subscribers.iter().filter(|one| one.is_subscribed()).all(Subscriber::is_written)
    }
}
