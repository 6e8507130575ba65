//! The publishing end of one connection: an XPUB socket to its peers.

use super::acceptor::Acceptor;
use super::connection::{Closed, Connection};
use super::link::SendLink;
use super::link_count::LinkCount;
use super::shared_memory::Sharing;
use super::topics::Topics;
use super::zmtp::{PeerReady, SocketType};
use super::{Medium, zmtp};
use crate::runtime_dir::SystemDir;
use crate::transport::{Endpoint, Peer, PeerKind, Sender, TransportError};
use std::sync::Arc;
use std::task::{Context, Poll};

pub(super) struct Publisher {
    acceptor: Acceptor,
    /// Connections that have not subscribed to anything yet.
    unsubscribed: Vec<Candidate>,
    links: Arc<LinkCount>,
}

struct Candidate {
    connection: Connection,
    ready: PeerReady,
}

impl Publisher {
    pub(super) fn open(dir: &Arc<SystemDir>, medium: Medium, endpoint: &Endpoint) -> Result<Self, TransportError> {
        let scl = zmtp::SclReady { lossless: endpoint.lossless, ..zmtp::SclReady::default() };
        // What subscribers send is short, whatever the limit for messages is.
        let endpoint = Endpoint { max_size: zmtp::COMMAND_LIMIT, ..endpoint.clone() };
        let acceptor = Acceptor::open(dir, medium, &endpoint, SocketType::XPub, scl)?.offering_memory()?;
        Ok(Self { acceptor, unsubscribed: Vec::new(), links: Arc::default() })
    }

    fn peer(&self, candidate: Candidate, topics: Topics) -> Peer {
        let Candidate { connection, ready } = candidate;
        let kind = if ready.scl.is_some() { PeerKind::Component } else { PeerKind::Foreign };
        let sharing = Sharing::new(self.acceptor.dir(), &ready);
        Peer { kind, link: Box::new(SendLink::new(connection, &ready, Some(topics), sharing, self.links.new_link())) }
    }
}

impl Sender for Publisher {
    fn poll_peer(&mut self, cx: &mut Context<'_>) -> Poll<Peer> {
        loop {
            let open = self.unsubscribed.len() + self.links.count();
            let Poll::Ready((connection, ready)) = self.acceptor.poll_connection(cx, open) else { break };
            self.unsubscribed.push(Candidate { connection, ready });
        }
        let mut index = 0;
        while let Some(candidate) = self.unsubscribed.get_mut(index) {
            match poll_subscribed(&mut candidate.connection, cx) {
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
        self.unsubscribed.iter_mut().for_each(|candidate| candidate.connection.detach());
    }
}

/// Ready with the first subscription of a peer.
pub(super) fn poll_subscribed(connection: &mut Connection, cx: &mut Context<'_>) -> Poll<Result<Topics, Closed>> {
    if !connection.is_written() {
        connection.flush(cx)?;
    }
    let mut topics = Topics::default();
    while topics.is_empty() {
        let subscription = match connection.poll_item(cx) {
            Poll::Ready(item) => item?.into_subscription(),
            Poll::Pending => return Poll::Pending,
        };
        if let Some(subscription) = subscription {
            topics.handle(subscription)?;
        }
    }
    Poll::Ready(Ok(topics))
}
