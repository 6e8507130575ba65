//! One end of any role, and a message exchanged with its counterpart.

use super::stage::{Outgoing, Stage, endpoint};
use crate::transport::zeromq::zmtp::SocketType;
use crate::transport::{Answer, Endpoint, Receiver, Replier, Requester, Tap, Transport};
use bytes::Bytes;
use std::future::poll_fn;
use std::pin::pin;
use std::task::{Context, Poll};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Publish,
    Pull,
    Reply,
    Tap,
    Subscribe,
    Push,
    Request,
}

pub(super) const LISTENING: [Role; 4] = [Role::Publish, Role::Pull, Role::Reply, Role::Tap];
pub(super) const CONNECTING: [Role; 3] = [Role::Subscribe, Role::Push, Role::Request];

pub(super) enum End {
    Sender(Outgoing),
    Receiver(Box<dyn Receiver>),
    Requester(Box<dyn Requester>),
    Replier(Box<dyn Replier>),
    Tap(Box<dyn Tap>),
}

impl Role {
    /// A plain socket that can talk to this role.
    pub(super) fn plain_peer(self) -> &'static str {
        match self {
            Self::Publish | Self::Tap => "SUB",
            Self::Pull => "PUSH",
            Self::Reply => "REQ",
            Self::Subscribe => "PUB",
            Self::Push => "PULL",
            Self::Request => "REP",
        }
    }

    pub(super) fn socket(self) -> SocketType {
        match self {
            Self::Publish | Self::Tap => SocketType::XPub,
            Self::Pull => SocketType::Pull,
            Self::Reply => SocketType::Router,
            Self::Subscribe => SocketType::Sub,
            Self::Push => SocketType::Push,
            Self::Request => SocketType::Dealer,
        }
    }

    fn counterpart(self) -> Self {
        match self {
            Self::Publish | Self::Tap => Self::Subscribe,
            Self::Pull => Self::Push,
            Self::Reply => Self::Request,
            Self::Subscribe => Self::Publish,
            Self::Push => Self::Pull,
            Self::Request => Self::Reply,
        }
    }

    pub(super) fn open(self, stage: &Stage) -> End {
        self.open_at(stage, &endpoint())
    }

    pub(super) fn open_at(self, stage: &Stage, endpoint: &Endpoint) -> End {
        let transport = &stage.transport;
        match self {
            Self::Publish => End::Sender(Outgoing::new(transport.publish(endpoint).unwrap())),
            Self::Push => End::Sender(Outgoing::new(transport.push(endpoint).unwrap())),
            Self::Pull => End::Receiver(transport.pull(endpoint).unwrap()),
            Self::Subscribe => End::Receiver(transport.subscribe(endpoint).unwrap()),
            Self::Reply => End::Replier(transport.reply(endpoint).unwrap()),
            Self::Request => End::Requester(transport.request(endpoint).unwrap()),
            Self::Tap => End::Tap(transport.tap(endpoint).unwrap().unwrap()),
        }
    }
}

impl End {
    /// Does what a gate does that has nothing to send; returns the messages and requests that arrive.
    pub(super) fn drive(&mut self, cx: &mut Context<'_>) -> Vec<Bytes> {
        let mut received = Vec::new();
        match self {
            Self::Sender(sender) => sender.drive(cx),
            Self::Receiver(receiver) => {
                while let Poll::Ready(message) = receiver.poll_recv(cx) {
                    received.push(message);
                }
            }
            Self::Requester(requester) => {
                let _not_always = requester.poll_connected(cx);
            }
            Self::Replier(replier) => {
                while let Poll::Ready(request) = replier.poll_request(cx) {
                    let _gone_requesters_do_not_matter = request.path.reply(&request.envelope, request.body.clone());
                    received.push(request.body);
                }
            }
            Self::Tap(tap) => {
                tap.drive(cx);
            }
        }
        received
    }

    /// Keeps this end going until a future is ready.
    pub(super) async fn during<T>(&mut self, future: impl Future<Output = T>) -> T {
        let mut future = pin!(future);
        poll_fn(|cx| {
            self.drive(cx);
            future.as_mut().poll(cx)
        })
        .await
    }

    pub(super) fn peers(&self) -> usize {
        match self {
            Self::Sender(sender) => sender.peers.len(),
            Self::Receiver(receiver) => receiver.peers(),
            Self::Requester(requester) => requester.is_connected().into(),
            Self::Replier(replier) => replier.peers(),
            Self::Tap(_) => 0,
        }
    }
}

/// Lets a good peer of SCL's exchange a message with this end.
pub(super) async fn exchange(stage: &Stage, role: Role, end: &mut End) {
    let mut peer = role.counterpart().open(stage);
    let expected = Bytes::from_static(b"still there?");
    poll_fn(|cx| {
        let received = [end.drive(cx), peer.drive(cx)].concat();
        if received.contains(&expected) {
            return Poll::Ready(());
        }
        match (&mut *end, &mut peer) {
            (End::Sender(sender), _) | (_, End::Sender(sender)) => {
                // Other peers may be connected here too.
                for peer in &mut sender.peers {
                    if peer.queue.is_empty() {
                        peer.queue.push_back(expected.clone().into());
                    }
                }
                sender.drive(cx);
                if !sender.peers.is_empty() {
                    cx.waker().wake_by_ref();
                }
            }
            (End::Requester(requester), _) | (_, End::Requester(requester)) => {
                if requester.is_connected() {
                    let _sent_again_when_connected = requester.request(cx, 7, expected.clone());
                    if let Poll::Ready(Answer::Reply { body, .. }) = requester.poll_answer(cx) {
                        assert_eq!(body, expected);
                    }
                    cx.waker().wake_by_ref();
                }
            }
            (End::Tap(tap), End::Receiver(observer)) => {
                tap.observe(cx, &expected, b"meta");
                // SCL's own subscribers take messages of one frame; here that shows that one arrived.
                if observer.malformed() > 0 {
                    return Poll::Ready(());
                }
                cx.waker().wake_by_ref();
            }
            _ => unreachable!("these are no counterparts"),
        }
        Poll::Pending
    })
    .await;
}
