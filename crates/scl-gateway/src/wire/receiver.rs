//! The end of a route at which messages arrive at this host.

use std::task::{Context, Poll};
use std::time::Instant;

use bytes::Bytes;

use super::keys::Side;
use super::link::Link;
use super::mail::ReceivingMail;
use super::stream::{Received, ReceivingEnd};
use super::token::EndToken;
use crate::route::Route;

/// Receives the messages of one route: in order, each at most once.
#[derive(Debug)]
pub struct WireReceiver {
    link: Link,
    end: ReceivingEnd,
    token: EndToken,
}

/// Event of [`WireReceiver::poll_event`].
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReceiverEvent {
    /// The sending side is open.
    Matched,
    /// The sending side closed, or the link is lost.
    Unmatched,
    /// The next message was sent then, before this side was opened.
    Latched(Instant),
    /// The next message. Messages are numbered 1, 2, 3, ... since the last `set_open(true)`.
    Message(Bytes),
    /// The sending component wants its messages acknowledged now, for a flush.
    AcknowledgementRequested,
}

impl WireReceiver {
    pub(super) fn new(link: &Link, route: &Route) -> Self {
        let end = ReceivingEnd::new(&link.commands, &route.from.host, &route.key, route.max_size);
        let mail = end.mail();
        link.presence.watch(end.id(), &route.from.host, &route.key, Side::Sender, move |peer| {
            mail.push(0, ReceivingMail::Peer(peer));
        });
        WireReceiver { link: link.clone(), end, token: EndToken::new(link, &route.key, Side::Receiver) }
    }

    /// Opens or closes this side. Closed at first. Each opening is a new epoch: the sender gives up what the last one did
    /// not acknowledge, messages are numbered from 1 again, and what was not polled is discarded.
    pub fn set_open(&mut self, open: bool) {
        match (open, self.token.set_open(open)) {
            (true, Some(epoch)) => self.end.open(epoch),
            (false, _) => self.end.close(),
            (true, None) => (),
        }
    }

    /// The next event.
    pub fn poll_event(&mut self, cx: &mut Context<'_>) -> Poll<ReceiverEvent> {
        self.end.poll(cx).map(|event| match event {
            Received::Matched => ReceiverEvent::Matched,
            Received::Unmatched => ReceiverEvent::Unmatched,
            Received::Latched(sent) => ReceiverEvent::Latched(sent),
            Received::Message(message) => ReceiverEvent::Message(message),
            Received::Flush => ReceiverEvent::AcknowledgementRequested,
        })
    }

    /// Tells the sender that the component has taken the first `count` messages since the last `set_open(true)`.
    pub fn acknowledge(&mut self, count: u64) {
        self.end.acknowledge(count);
    }
}

impl Drop for WireReceiver {
    fn drop(&mut self) {
        self.link.presence.unwatch(self.end.id());
    }
}
