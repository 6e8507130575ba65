//! The pushing end, which connects to one puller: a PUSH socket to it.

use super::dialler::Dialler;
use super::link::SendLink;
use super::zmtp::{self, SocketType};
use crate::runtime_dir::SystemDir;
use crate::transport::link_count::LinkCount;
use crate::transport::{Endpoint, Peer, Sender};
use std::sync::Arc;
use std::task::{Context, Poll, ready};

pub(super) struct Pusher {
    dialler: Dialler,
    links: Arc<LinkCount>,
}

impl Pusher {
    pub(super) fn open(dir: &Arc<SystemDir>, endpoint: &Endpoint) -> Self {
        let scl = zmtp::SclReady { lossless: endpoint.lossless, ..zmtp::SclReady::default() };
        let dialler = Dialler::new(dir, endpoint, SocketType::Push, scl);
        Self { dialler, links: Arc::default() }
    }
}

impl Sender for Pusher {
    fn poll_peer(&mut self, cx: &mut Context<'_>) -> Poll<Peer> {
        self.links.wake_on_drop(cx);
        if self.links.count() > 0 {
            return Poll::Pending;
        }
        let (session, ready) = ready!(self.dialler.poll_connected(cx));
        let link = SendLink::new(&self.dialler.dir, session, &ready, self.links.new_link());
        Poll::Ready(Peer { kind: ready.kind(), link: Box::new(link) })
    }

    fn refusal(&self) -> Option<String> {
        self.dialler.refusal()
    }

    fn detach(&mut self) {
        self.dialler.detach();
    }
}
