//! The end of a route at which messages arrive at this host.

use std::task::{Context, Poll};

use super::Link;
use super::keys::Side;
use super::mailbox::ReceivingMail;
use super::presence::Watching;
use super::stream::{ReceiverEvent, ReceivingEnd};
use super::token::EndToken;
use crate::route::Route;

/// Receives the messages of one route: in order, each at most once.
#[derive(Debug)]
pub struct WireReceiver {
    _watching: Watching,
    end: ReceivingEnd,
    token: EndToken,
}

impl WireReceiver {
    pub(super) fn new(link: &Link, route: &Route) -> Self {
        let end = ReceivingEnd::new(&link.commands, &route.from.host, &route.key, route.max_size);
        let mail = end.mail();
        let watching = link.presence.watch(end.id(), &route.from.host, &route.key, Side::Sender, move |peer| {
            mail.push(0, ReceivingMail::Peer(peer));
        });
        WireReceiver { _watching: watching, end, token: EndToken::new(link, &route.key, Side::Receiver) }
    }

    /// Opens or closes this side, which is closed at first. Each opening starts a new epoch: the sender gives up the
    /// messages that were not acknowledged in the previous one, messages are numbered from 1 again, and messages that
    /// were not polled are discarded.
    pub fn set_open(&mut self, open: bool) {
        match (open, self.token.set_open(open)) {
            (true, Some(epoch)) => self.end.open(epoch),
            (false, _) => self.end.close(),
            (true, None) => (),
        }
    }

    /// Polls for the next event.
    pub fn poll_event(&mut self, cx: &mut Context<'_>) -> Poll<ReceiverEvent> {
        self.end.poll(cx)
    }

    /// Tells the sender that the component has taken the first `count` messages since the last `set_open(true)`.
    pub fn acknowledge(&mut self, count: u64) {
        self.end.acknowledge(count);
    }
}
