//! Ends in a temporary folder, and what moves them on.

use crate::runtime_dir::{RuntimeDir, SystemDir};
use crate::transport::zeromq::zmtp::ConnectionId;
use crate::transport::zeromq::{TransportKind, ZeroMq};
use crate::transport::{Endpoint, Frame, Link, Peer, PeerKind, Receiver, Sender, Transport};
use bytes::Bytes;
use std::collections::VecDeque;
use std::future::poll_fn;
use std::pin::pin;
use std::task::{Context, Poll};
use tempfile::TempDir;

pub(super) const ENDPOINT: &str = "sensor.out--controller.in.1a2b3c4d";

pub(super) struct Stage {
    _folder: TempDir,
    pub(super) dir: SystemDir,
    pub(super) transport: ZeroMq,
}

impl Stage {
    pub(super) fn new(kind: TransportKind) -> Self {
        let folder = TempDir::with_prefix("scl").unwrap();
        let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into());
        let dir = RuntimeDir::locate(&variable).unwrap().system("rover").unwrap();
        Self { _folder: folder, transport: ZeroMq::new(dir.clone(), kind), dir }
    }

    /// What all ends here say about their connection.
    pub(super) fn connection(&self) -> ConnectionId {
        ConnectionId::of(&self.dir, ENDPOINT)
    }

    pub(super) fn publisher(&self) -> Outgoing {
        Outgoing::new(self.transport.publish(&endpoint()).unwrap())
    }

    pub(super) fn pusher(&self) -> Outgoing {
        Outgoing::new(self.transport.push(&endpoint()).unwrap())
    }

    pub(super) fn subscriber(&self) -> Box<dyn Receiver> {
        self.transport.subscribe(&endpoint()).unwrap()
    }

    pub(super) fn puller(&self) -> Box<dyn Receiver> {
        self.transport.pull(&endpoint()).unwrap()
    }
}

pub(super) fn endpoint() -> Endpoint {
    Endpoint::new(ENDPOINT)
}

pub(super) fn newest_only() -> Endpoint {
    Endpoint { newest_only: true, ..endpoint() }
}

/// A sending end with the queue that a gate has for each of its peers.
pub(super) struct Outgoing {
    pub(super) end: Box<dyn Sender>,
    pub(super) peers: Vec<Queued>,
}

pub(super) struct Queued {
    pub(super) kind: PeerKind,
    pub(super) link: Box<dyn Link>,
    pub(super) queue: VecDeque<Frame>,
}

impl Outgoing {
    pub(super) fn new(end: Box<dyn Sender>) -> Self {
        Self { end, peers: Vec::new() }
    }

    /// Does what a gate does each time it is polled.
    pub(super) fn drive(&mut self, cx: &mut Context<'_>) {
        while let Poll::Ready(Peer { kind, link }) = self.end.poll_peer(cx) {
            self.peers.push(Queued { kind, link, queue: VecDeque::new() });
        }
        self.peers.retain_mut(|peer| {
            let driven = peer.link.drive(cx).ok();
            let is_connected = driven.is_some();
            peer.link.send_all(cx, driven, &mut peer.queue, &mut |_| {});
            is_connected
        });
        // A link that was dropped may have been the only reason not to connect again.
        while let Poll::Ready(Peer { kind, link }) = self.end.poll_peer(cx) {
            self.peers.push(Queued { kind, link, queue: VecDeque::new() });
        }
    }

    /// Keeps this end going until a future is ready.
    pub(super) async fn during<T>(&mut self, future: impl Future<Output = T>) -> T {
        let mut future = pin!(future);
        poll_fn(|cx| {
            self.drive(cx);
            let ready = future.as_mut().poll(cx);
            self.drive(cx);
            ready
        })
        .await
    }

    pub(super) async fn until(&mut self, mut done: impl FnMut(&mut Self) -> bool) {
        poll_fn(|cx| {
            self.drive(cx);
            if done(self) { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
    }

    /// Waits for a number of peers, with a receiver kept going.
    pub(super) async fn until_peers(&mut self, peers: usize, receiver: &mut dyn Receiver) {
        poll_fn(|cx| {
            self.drive(cx);
            assert!(receiver.poll_recv(cx).is_pending(), "received what was not sent");
            if self.peers.len() == peers { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
    }

    pub(super) fn queue(&mut self, messages: impl IntoIterator<Item = Bytes>) {
        self.peers[0].queue.extend(messages.into_iter().map(Frame::from));
    }

    pub(super) fn link(&mut self) -> &mut dyn Link {
        &mut *self.peers[0].link
    }
}

pub(super) async fn next(receiver: &mut dyn Receiver) -> Bytes {
    poll_fn(|cx| receiver.poll_recv(cx)).await
}

/// Polls something once, whatever comes of it.
pub(super) async fn once<T>(mut poll: impl FnMut(&mut Context<'_>) -> T) -> T {
    poll_fn(|cx| Poll::Ready(poll(cx))).await
}

pub(super) fn numbered(numbers: std::ops::Range<u32>) -> impl Iterator<Item = Bytes> {
    numbers.map(|number| Bytes::copy_from_slice(&number.to_be_bytes()))
}

pub(super) fn number(message: &[u8]) -> u32 {
    u32::from_be_bytes(message.try_into().unwrap())
}

pub(super) fn pattern(size: usize) -> Bytes {
    (0..size).map(|place| (place % 251) as u8).collect()
}
