//! The publishing end of one connection: an XPUB socket to its peers.

use super::acceptor::Acceptor;
use super::link::SendLink;
use super::subscribers::{Subscriber, Subscribers};
use super::zmtp::SocketType;
use super::{TransportKind, zmtp};
use crate::runtime_dir::SystemDir;
use crate::transport::link_count::LinkCount;
use crate::transport::{Endpoint, Peer, Sender, TransportError};
use std::sync::Arc;
use std::task::{Context, Poll, ready};

pub(super) struct Publisher {
    subscribers: Subscribers,
    links: Arc<LinkCount>,
}

impl Publisher {
    pub(super) fn open(dir: &Arc<SystemDir>, kind: TransportKind, endpoint: &Endpoint) -> Result<Self, TransportError> {
        let Endpoint { lossless, latched, .. } = *endpoint;
        let scl = zmtp::SclReady { lossless, latched, ..zmtp::SclReady::default() };
        let acceptor = Acceptor::open(dir, kind, endpoint, SocketType::XPub, scl)?.offering_memory()?;
        Ok(Self { subscribers: Subscribers::new(acceptor), links: Arc::default() })
    }
}

impl Sender for Publisher {
    fn poll_peer(&mut self, cx: &mut Context<'_>) -> Poll<Peer> {
        let subscriber = ready!(self.subscribers.poll_next(cx, self.links.count()));
        let Subscriber { session, ready, resumed, topics } = subscriber;
        let link = SendLink::new(&self.subscribers.acceptor.dir, session, &ready, self.links.new_link());
        Poll::Ready(Peer { kind: ready.kind(), link: Box::new(link.subscribed(topics, resumed)) })
    }

    fn detach(&mut self) {
        self.subscribers.detach();
    }
}
