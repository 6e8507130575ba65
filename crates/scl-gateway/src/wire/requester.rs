//! The end of a route at which requests leave this host.

use std::collections::{HashMap, VecDeque};
use std::task::{Context, Poll, Waker};

use bytes::Bytes;

use super::Link;
use super::envelope::{self, Envelope, Outcome};
use super::keys::{self, Side};
use super::mailbox::SendingMail;
use super::presence::Watching;
use super::stream::{ReceiverEvent, ReceivingEnd, SenderEvent, SendingEnd};
use super::token::EndToken;
use crate::route::Route;

/// Sends requests to the `rep` gate of another host. Always open.
#[derive(Debug)]
pub struct WireRequester {
    _watching: Watching,
    requests: SendingEnd,
    replies: ReceivingEnd,
    /// Its number identifies to the replier the receiving end of the replies.
    _token: EndToken,
    /// The caller's ids by ours, which are never used twice.
    open: HashMap<u64, u64>,
    last: u64,
    replied: u64,
    events: VecDeque<RequesterEvent>,
    waker: Option<Waker>,
}

/// Event of [`WireRequester::poll_event`].
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum RequesterEvent {
    /// The replying side is open.
    Matched,
    /// The replying side closed, or the link is lost. Open requests end with `Gone`.
    Unmatched,
    /// The reply to request `id`.
    Reply { id: u64, body: Bytes },
    /// Request `id` gets no reply.
    Gone { id: u64 },
    /// Request `id` gets no reply, because the replying component has refused it.
    Refused { id: u64 },
}

impl WireRequester {
    pub(super) fn new(link: &Link, route: &Route) -> Self {
        let (host, key) = (&route.to.host, &route.key);
        let requests = SendingEnd::new(&link.commands, host, key, route.queue, false);
        let max_size = route.max_size.saturating_add(envelope::LENGTH as u64);
        let mut replies = ReceivingEnd::new(&link.commands, host, &keys::replies(key), max_size);
        let mut token = EndToken::new(link, key, Side::Sender);
        if let Some(number) = token.set_open(true) {
            replies.open(number);
        }
        let mail = requests.mail();
        let watching = link.presence.watch(requests.id(), host, key, Side::Receiver, move |peer| {
            mail.push(0, SendingMail::Peer(peer));
        });
        WireRequester {
            _watching: watching,
            requests,
            replies,
            _token: token,
            open: HashMap::new(),
            last: 0,
            replied: 0,
            events: VecDeque::new(),
            waker: None,
        }
    }

    /// Polls for the next event.
    pub fn poll_event(&mut self, cx: &mut Context<'_>) -> Poll<RequesterEvent> {
        loop {
            if let Some(event) = self.events.pop_front() {
                return Poll::Ready(event);
            }
            // Replies first: those that arrived before the replier was lost still count.
            if let Poll::Ready(received) = self.replies.poll(cx) {
                self.received(received);
                continue;
            }
            match self.requests.poll(cx) {
                Poll::Ready(SenderEvent::Matched) => {
                    self.all_gone();
                    self.events.push_back(RequesterEvent::Matched);
                }
                Poll::Ready(SenderEvent::Unmatched) => {
                    self.all_gone();
                    self.events.push_back(RequesterEvent::Unmatched);
                }
                Poll::Ready(_) => (),
                Poll::Pending => break,
            }
        }
        self.waker = Some(cx.waker().clone());
        Poll::Pending
    }

    /// Sends a request. `id` must be unused among the open requests. Exactly one `Reply`, `Refused` or `Gone` follows;
    /// without a match it is `Gone`.
    pub fn request(&mut self, id: u64, body: Bytes) {
        if !self.requests.is_matched() {
            self.events.push_back(RequesterEvent::Gone { id });
            if let Some(waker) = self.waker.take() {
                waker.wake();
            }
            return;
        }
        self.last += 1;
        self.open.insert(self.last, id);
        self.requests.send(Envelope { outcome: Outcome::Message, id: self.last, body }.encode(), None);
    }

    fn received(&mut self, received: ReceiverEvent) {
        let ReceiverEvent::Message(message) = received else { return };
        self.replied += 1;
        self.replies.acknowledge(self.replied);
        let Some(reply) = Envelope::decode(&message) else { return };
        let Some(id) = self.open.remove(&reply.id) else { return };
        self.events.push_back(match reply.outcome {
            Outcome::Message => RequesterEvent::Reply { id, body: reply.body },
            Outcome::Gone => RequesterEvent::Gone { id },
            Outcome::Refused => RequesterEvent::Refused { id },
        });
    }

    /// Ends all requests with `Gone`: no other replier may handle them once their callers know that they failed.
    fn all_gone(&mut self) {
        if self.requests.unacknowledged() > 0 {
            self.requests.abandon();
        }
        let mut gone: Vec<_> = self.open.drain().collect();
        gone.sort_unstable();
        self.events.extend(gone.into_iter().map(|(_, id)| RequesterEvent::Gone { id }));
    }
}
