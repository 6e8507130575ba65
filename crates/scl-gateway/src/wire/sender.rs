//! The end of a route at which messages leave this host.

use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll};
use std::time::Instant;

use bytes::Bytes;

use super::keys::Side;
use super::link::Link;
use super::mailbox::SendingMail;
use super::presence::Watching;
use super::stream::{SendingEnd, Sent};
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
    /// Whether the owner is yet to be told that the receiver is another one than before.
    is_new_receiver: bool,
    /// Whether the owner waits for credit, and whether there is more since the last time it was told.
    wants_credit: AtomicBool,
    has_more: bool,
}

/// Event of [`WireSender::poll_event`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SenderEvent {
    /// The receiving side is open. What was unacknowledged has been sent again if it is the same one as before.
    Matched,
    /// On a latched route, after `Matched`: this receiver has got nothing yet, it is not the one before.
    NewReceiver,
    /// The receiving side closed, or the link is lost. Unacknowledged messages stay here for the next match.
    Unmatched,
    /// All messages up to this number are taken by the receiving component (or were given up before).
    Acknowledged(u64),
    /// This many of the oldest messages were unacknowledged when another receiver took the place of theirs: whether
    /// they arrived is unknown, and they are not sent again. Comes after the `Matched` of the new receiver.
    GivenUp(u64),
    /// [`may_send`](WireSender::may_send) was false and could be true now.
    Credit,
}

impl WireSender {
    pub(super) fn new(link: &Link, route: &Route) -> Self {
        let end = SendingEnd::new(&link.commands, &route.to.host, &route.key, route.queue, route.latched);
        let mail = end.mail();
        let watching = link.presence.watch(end.id(), &route.to.host, &route.key, Side::Receiver, move |peer| {
            mail.push(0, SendingMail::Peer(peer));
        });
        let token = EndToken::new(link, &route.key, Side::Sender);
        WireSender {
            _watching: watching,
            end,
            token,
            latches: route.latched,
            is_new_receiver: false,
            wants_credit: AtomicBool::new(false),
            has_more: false,
        }
    }

    /// Shows or withdraws this side's presence. Closed at first. Closing keeps what is unacknowledged.
    pub fn set_open(&mut self, open: bool) {
        self.token.set_open(open);
    }

    /// The next event. Must be polled while messages are on their way: it also sends what got lost again.
    pub fn poll_event(&mut self, cx: &mut Context<'_>) -> Poll<SenderEvent> {
        if std::mem::take(&mut self.is_new_receiver) {
            return Poll::Ready(SenderEvent::NewReceiver);
        }
        let sent = self.end.poll(cx);
        self.has_more |= sent.is_ready();
        let event = match sent {
            Poll::Ready(Sent::Matched { is_new, .. }) => {
                self.is_new_receiver = self.latches && is_new;
                SenderEvent::Matched
            }
            Poll::Ready(Sent::Unmatched) => SenderEvent::Unmatched,
            Poll::Ready(Sent::Settled(count)) => SenderEvent::Acknowledged(count),
            Poll::Ready(Sent::GivenUp(count)) => SenderEvent::GivenUp(count),
            Poll::Pending if self.is_credit_due() => SenderEvent::Credit,
            Poll::Pending => return Poll::Pending,
        };
        Poll::Ready(event)
    }

    fn is_credit_due(&mut self) -> bool {
        let is_due = self.has_more && self.end.may_send(0) && self.wants_credit.swap(false, Ordering::Relaxed);
        self.has_more &= !is_due;
        is_due
    }

    /// Returns true if the other side is matched and a message of this length fits into the window.
    pub fn may_send(&self, length: usize) -> bool {
        let may = self.end.may_send(length);
        self.wants_credit.store(!may && self.end.unacknowledged() > 0, Ordering::Relaxed);
        may
    }

    /// Sends a message. The caller asks [`may_send`](Self::may_send) before; a message sent without credit or match is
    /// kept and sent when there is.
    pub fn send(&mut self, message: Bytes) {
        self.end.send(message, None);
    }

    /// The same for a message that was sent then, before the receiver had joined.
    pub fn send_latched(&mut self, message: Bytes, sent: Instant) {
        self.end.send(message, Some(sent));
    }

    /// Asks the other side for [`ReceiverEvent::AcknowledgementRequested`](super::ReceiverEvent), for a flush.
    pub fn request_acknowledgement(&mut self) {
        self.end.request_flush();
    }

    /// How often messages had to be sent again because they got lost, other than with the link.
    pub fn losses(&self) -> u64 {
        self.end.losses()
    }

    /// Number of messages sent and neither acknowledged nor given up.
    pub fn unacknowledged(&self) -> u64 {
        self.end.unacknowledged()
    }
}
