//! The publishing end of one connection: an XPUB socket to its peers.

use super::acceptor::Acceptor;
use super::link::SendLink;
use super::link_count::LinkCount;
use super::session::{Closed, Session};
use super::shared_memory::Sharing;
use super::topics::Topics;
use super::zmtp::{Command, Item, PeerReady, SocketType};
use super::{TransportKind, zmtp};
use crate::runtime_dir::SystemDir;
use crate::transport::{Endpoint, Peer, PeerKind, Resumed, Sender, TransportError};
use std::sync::Arc;
use std::task::{Context, Poll, ready};

pub(super) struct Publisher {
    acceptor: Acceptor,
    /// Connections that have not subscribed to anything yet.
    unsubscribed: Vec<Candidate>,
    links: Arc<LinkCount>,
}

struct Candidate {
    session: Session,
    ready: PeerReady,
    resumed: Option<Resumed>,
}

impl Publisher {
    pub(super) fn open(dir: &Arc<SystemDir>, kind: TransportKind, endpoint: &Endpoint) -> Result<Self, TransportError> {
        let Endpoint { lossless, latched, .. } = *endpoint;
        let scl = zmtp::SclReady { lossless, latched, ..zmtp::SclReady::default() };
        // What subscribers send is short, whatever the limit for messages is.
        let endpoint = Endpoint { max_size: zmtp::COMMAND_LIMIT, ..endpoint.clone() };
        let acceptor = Acceptor::open(dir, kind, &endpoint, SocketType::XPub, scl)?.offering_memory()?;
        Ok(Self { acceptor, unsubscribed: Vec::new(), links: Arc::default() })
    }

    fn peer(&self, candidate: Candidate, topics: Topics) -> Peer {
        let Candidate { session, ready, resumed } = candidate;
        let kind = if ready.scl.is_some() { PeerKind::Component } else { PeerKind::Foreign };
        let sharing = Sharing::new(self.acceptor.dir(), &ready);
        let link = SendLink::new(session, &ready, Some(topics), sharing, self.links.new_link());
        Peer { kind, link: Box::new(link.of_resumed(resumed)) }
    }
}

impl Sender for Publisher {
    fn poll_peer(&mut self, cx: &mut Context<'_>) -> Poll<Peer> {
        loop {
            let open = self.unsubscribed.len() + self.links.count();
            let Poll::Ready((session, ready)) = self.acceptor.poll_session(cx, open) else { break };
            self.unsubscribed.push(Candidate { session, ready, resumed: None });
        }
        let mut index = 0;
        while let Some(candidate) = self.unsubscribed.get_mut(index) {
            match poll_subscribed(&mut candidate.session, &mut candidate.resumed, cx) {
                Poll::Ready(Ok(topics)) => {
                    let candidate = self.unsubscribed.swap_remove(index);
                    return Poll::Ready(self.peer(candidate, topics));
                }
                Poll::Ready(Err(error)) => {
                    tracing::debug!(%error, "a subscriber left");
                    self.unsubscribed.swap_remove(index);
                }
                Poll::Pending => index += 1,
            }
        }
        Poll::Pending
    }

    fn detach(&mut self) {
        self.acceptor.detach();
        self.unsubscribed.iter_mut().for_each(|candidate| candidate.session.detach());
    }
}

/// Ready with the first subscription of a peer. What it says before that about itself goes into `resumed`.
pub(super) fn poll_subscribed(
    session: &mut Session,
    resumed: &mut Option<Resumed>,
    cx: &mut Context<'_>,
) -> Poll<Result<Topics, Closed>> {
    if !session.is_written() {
        session.flush(cx)?;
    }
    let mut topics = Topics::default();
    while topics.is_empty() {
        match ready!(session.poll_item(cx))? {
            Item::Command(Command::Resume(peer)) => *resumed = Some(peer),
            item => {
                if let Some(subscription) = item.into_subscription() {
                    topics.handle(subscription)?;
                }
            }
        }
    }
    Poll::Ready(Ok(topics))
}
