//! The end of a route at which requests arrive at this host.

use std::collections::HashMap;
use std::task::{Context, Poll, ready};

use bytes::Bytes;

use super::Link;
use super::envelope::{self, Envelope, Outcome};
use super::keys::{self, Side};
use super::mailbox::{ReceivingMail, SendingMail};
use super::presence::Watching;
use super::stream::{ReceiverEvent, ReceivingEnd, SenderEvent, SendingEnd};
use super::token::EndToken;
use crate::route::Route;

/// Answers the requests of one route.
#[derive(Debug)]
pub struct WireReplier {
    _watching: Watching,
    requests: ReceivingEnd,
    replies: SendingEnd,
    token: EndToken,
    /// The requester's ids by ours.
    open: HashMap<u64, u64>,
    last: u64,
    /// Requests since this side was opened.
    taken: u64,
}

/// Event of [`WireReplier::poll_event`].
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReplierEvent {
    /// The requesting side's gateway is connected.
    Matched,
    /// The requesting side's gateway is not connected any more. Its requests may still be answered; the replies are
    /// discarded.
    Unmatched,
    /// A request. Ids are unique within this value.
    Request { id: u64, body: Bytes },
}

impl WireReplier {
    pub(super) fn new(link: &Link, route: &Route) -> Self {
        let (host, key) = (&route.from.host, &route.key);
        let max_size = route.max_size.saturating_add(envelope::LENGTH as u64);
        let requests = ReceivingEnd::new(&link.commands, host, key, max_size);
        let replies = SendingEnd::new(&link.commands, host, &keys::replies(key), route.queue, false);
        let (requests_mail, replies_mail) = (requests.mail(), replies.mail());
        let watching = link.presence.watch(requests.id(), host, key, Side::Sender, move |peer| {
            replies_mail.push(0, SendingMail::Peer(peer));
            requests_mail.push(0, ReceivingMail::Peer(peer));
        });
        WireReplier {
            _watching: watching,
            requests,
            replies,
            token: EndToken::new(link, key, Side::Receiver),
            open: HashMap::new(),
            last: 0,
            taken: 0,
        }
    }

    /// Opens or closes this side, which is closed at first. Closing gives up all open requests.
    pub fn set_open(&mut self, open: bool) {
        match (open, self.token.set_open(open)) {
            (true, Some(epoch)) => {
                self.taken = 0;
                self.requests.open(epoch);
            }
            (true, None) => (),
            (false, _) => {
                // The requester gives up its open requests itself when this side's token disappears.
                self.open.clear();
                self.requests.close();
            }
        }
    }

    /// Polls for the next event.
    pub fn poll_event(&mut self, cx: &mut Context<'_>) -> Poll<ReplierEvent> {
        loop {
            while let Poll::Ready(event) = self.replies.poll(cx) {
                if event == SenderEvent::NewReceiver {
                    self.open.clear();
                }
            }
            let event = match ready!(self.requests.poll(cx)) {
                ReceiverEvent::Matched => ReplierEvent::Matched,
                ReceiverEvent::Unmatched => ReplierEvent::Unmatched,
                ReceiverEvent::Message(message) => match self.request(&message) {
                    Some(event) => event,
                    None => continue,
                },
                ReceiverEvent::AcknowledgementRequested | ReceiverEvent::Latched(_) => continue,
            };
            return Poll::Ready(event);
        }
    }

    /// Answers request `id`. Unknown ids are ignored.
    pub fn reply(&mut self, id: u64, body: Bytes) {
        self.answer(id, Outcome::Message, body);
    }

    /// Ends request `id` without a reply: the requester gets `Gone`.
    pub fn give_up(&mut self, id: u64) {
        self.answer(id, Outcome::Gone, Bytes::new());
    }

    /// Ends request `id`, which the replying component has refused, without a reply: the requester gets `Refused`.
    pub fn refuse(&mut self, id: u64) {
        self.answer(id, Outcome::Refused, Bytes::new());
    }

    fn request(&mut self, message: &Bytes) -> Option<ReplierEvent> {
        self.taken += 1;
        self.requests.acknowledge(self.taken);
        let request = Envelope::decode(message)?;
        self.last += 1;
        self.open.insert(self.last, request.id);
        Some(ReplierEvent::Request { id: self.last, body: request.body })
    }

    fn answer(&mut self, id: u64, outcome: Outcome, body: Bytes) {
        if let Some(id) = self.open.remove(&id) {
            self.replies.send(Envelope { outcome, id, body }.encode(), None);
        }
    }
}
