//! Peers that connect to an XPUB socket, until they have subscribed to something.

use super::acceptor::Acceptor;
use super::session::{Closed, Session};
use super::topics::Topics;
use super::zmtp::{Command, Item, PeerReady};
use crate::transport::Resumed;
use std::task::{Context, Poll, ready};

pub(super) struct Subscribers {
    pub(super) acceptor: Acceptor,
    /// Connections that have not subscribed to anything yet.
    unsubscribed: Vec<Subscriber>,
}

pub(super) struct Subscriber {
    pub(super) session: Session,
    pub(super) ready: PeerReady,
    /// What the subscriber has reported about itself before subscribing.
    pub(super) resumed: Option<Resumed>,
    pub(super) topics: Topics,
}

impl Subscribers {
    pub(super) fn new(acceptor: Acceptor) -> Self {
        Self { acceptor, unsubscribed: Vec::new() }
    }

    pub(super) fn detach(&mut self) {
        self.acceptor.detach();
        self.unsubscribed.iter_mut().for_each(|subscriber| subscriber.session.detach());
    }

    /// Returns the next peer that has subscribed. `open`: how many peers returned earlier are still connected.
    pub(super) fn poll_next(&mut self, cx: &mut Context<'_>, open: usize) -> Poll<Subscriber> {
        while let Poll::Ready((session, ready)) = self.acceptor.poll_session(cx, open + self.unsubscribed.len()) {
            self.unsubscribed.push(Subscriber { session, ready, resumed: None, topics: Topics::default() });
        }
        let mut index = 0;
        while let Some(subscriber) = self.unsubscribed.get_mut(index) {
            match subscriber.poll_subscribed(cx) {
                Poll::Ready(Ok(())) => return Poll::Ready(self.unsubscribed.swap_remove(index)),
                Poll::Ready(Err(error)) => {
                    tracing::debug!(%error, "a subscriber left");
                    self.unsubscribed.swap_remove(index);
                }
                Poll::Pending => index += 1,
            }
        }
        Poll::Pending
    }
}

impl Subscriber {
    fn poll_subscribed(&mut self, cx: &mut Context<'_>) -> Poll<Result<(), Closed>> {
        if !self.session.is_written() {
            self.session.flush(cx)?;
        }
        while self.topics.is_empty() {
            match ready!(self.session.poll_item(cx))? {
                Item::Command(Command::Resume(peer)) => self.resumed = Some(peer),
                item => {
                    if let Some(subscription) = item.into_subscription() {
                        self.topics.handle(subscription)?;
                    }
                }
            }
        }
        Poll::Ready(Ok(()))
    }
}
