//! The end of a route at which messages leave this host.

use std::task::{Context, Poll, ready};
use std::time::Instant;

use bytes::Bytes;

use super::Link;
use super::keys::Side;
use super::mailbox::SendingMail;
use super::presence::Watching;
use super::stream::{SenderEvent, SendingEnd};
use super::token::EndToken;
use crate::route::Route;

/// Sends the messages of one route.
///
/// Messages are numbered 1, 2, 3, ... in the order of [`send`](Self::send), over the whole life of this value.
#[derive(Debug)]
pub struct WireSender {
    _watching: Watching,
    end: SendingEnd,
    token: EndToken,
    latches: bool,
}

impl WireSender {
    pub(super) fn new(link: &Link, route: &Route) -> Self {
        let end = SendingEnd::new(&link.commands, &route.to.host, &route.key, route.queue, route.latched);
        let mail = end.mail();
        let watching = link.presence.watch(end.id(), &route.to.host, &route.key, Side::Receiver, move |peer| {
            mail.push(0, SendingMail::Peer(peer));
        });
        let token = EndToken::new(link, &route.key, Side::Sender);
        WireSender { _watching: watching, end, token, latches: route.latched }
    }

    /// Opens or closes this side: shows or withdraws its presence. Closed at first. Closing keeps unacknowledged
    /// messages.
    pub fn set_open(&mut self, open: bool) {
        self.token.set_open(open);
    }

    /// Polls for the next event. Must be polled while messages are in flight, because it also sends lost messages
    /// again.
    pub fn poll_event(&mut self, cx: &mut Context<'_>) -> Poll<SenderEvent> {
        loop {
            match ready!(self.end.poll(cx)) {
                SenderEvent::NewReceiver if !self.latches => {}
                event => return Poll::Ready(event),
            }
        }
    }

    /// Returns true if the other side is matched and a message of this length fits into the window. It becomes true
    /// only after an event.
    pub fn may_send(&self, length: usize) -> bool {
        self.end.may_send(length)
    }

    /// Sends a message. Call [`may_send`](Self::may_send) first: a message sent without credit or without a match is
    /// kept, and sent as soon as there are both.
    pub fn send(&mut self, message: Bytes) {
        self.end.send(message, None);
    }

    /// Sends a message that its component sent at `sent`, before the receiver had joined.
    pub fn send_latched(&mut self, message: Bytes, sent: Instant) {
        self.end.send(message, Some(sent));
    }

    /// Asks the other side for [`ReceiverEvent::AcknowledgementRequested`](super::ReceiverEvent), for a flush.
    pub fn request_acknowledgement(&mut self) {
        self.end.request_flush();
    }

    /// How often messages had to be sent again because they were lost, other than through the loss of the link.
    pub fn losses(&self) -> u64 {
        self.end.losses()
    }

    /// Number of messages sent and neither acknowledged nor given up.
    pub fn unacknowledged(&self) -> u64 {
        self.end.unacknowledged()
    }
}
