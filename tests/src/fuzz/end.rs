//! An end of the `zeromq` transport, used as a gate uses it.

use scl::bytes::Bytes;
use scl::transport::zeromq::ZeroMq;
use scl::transport::{Answer, Endpoint, Link, Receiver, Replier, Requester, Sender, Transport, TransportError};
use std::collections::VecDeque;
use std::future::poll_fn;
use std::task::{Context, Poll};

pub(super) const ENDPOINT: &str = "a.out--b.in.1a2b3c4d";
/// The longest message that each end accepts.
const MAX_SIZE: usize = 1 << 20;

/// What two ends send each other.
const MESSAGE: Bytes = Bytes::from_static(b"a message between good peers");
const REQUEST: u64 = 0x0101_0101_0101_0101;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Publish,
    Pull,
    Reply,
    Subscribe,
    Push,
    Request,
}

impl Role {
    pub(super) const ALL: [Self; 6] =
        [Self::Publish, Self::Pull, Self::Reply, Self::Subscribe, Self::Push, Self::Request];

    pub(super) fn listens(self) -> bool {
        matches!(self, Self::Publish | Self::Pull | Self::Reply)
    }

    pub(super) fn counterpart(self) -> Self {
        match self {
            Self::Publish => Self::Subscribe,
            Self::Subscribe => Self::Publish,
            Self::Pull => Self::Push,
            Self::Push => Self::Pull,
            Self::Reply => Self::Request,
            Self::Request => Self::Reply,
        }
    }

    /// The socket type that this role has in ZMTP.
    pub(super) fn socket_type(self) -> &'static [u8] {
        match self {
            Self::Publish => b"XPUB",
            Self::Subscribe => b"SUB",
            Self::Pull => b"PULL",
            Self::Push => b"PUSH",
            Self::Reply => b"ROUTER",
            Self::Request => b"DEALER",
        }
    }
}

pub(super) enum End {
    Sender { end: Box<dyn Sender>, links: Vec<Box<dyn Link>> },
    Receiver(Box<dyn Receiver>),
    Replier(Box<dyn Replier>),
    Requester { end: Box<dyn Requester>, waits: bool },
}

impl End {
    pub(super) fn open(role: Role, newest_only: bool, transport: &ZeroMq) -> Result<Self, TransportError> {
        let mut endpoint = Endpoint::new(ENDPOINT);
        (endpoint.max_size, endpoint.newest_only) = (MAX_SIZE, newest_only);
        Ok(match role {
            Role::Publish => Self::Sender { end: transport.publish(&endpoint)?, links: Vec::new() },
            Role::Push => Self::Sender { end: transport.push(&endpoint)?, links: Vec::new() },
            Role::Subscribe => Self::Receiver(transport.subscribe(&endpoint)?),
            Role::Pull => Self::Receiver(transport.pull(&endpoint)?),
            Role::Reply => Self::Replier(transport.reply(&endpoint)?),
            Role::Request => Self::Requester { end: transport.request(&endpoint)?, waits: false },
        })
    }

    /// Sends the message to each peer, receives what has arrived, answers requests. Returns true if the message
    /// arrived.
    fn turn(&mut self, cx: &mut Context<'_>) -> bool {
        match self {
            Self::Sender { end, links } => {
                while let Poll::Ready(peer) = end.poll_peer(cx) {
                    links.push(peer.link);
                }
                links.retain_mut(|link| send(&mut **link, cx));
                false
            }
            Self::Receiver(end) => {
                let received = end.poll_recv(cx);
                if received.is_pending() && end.poll_caught_up(cx).is_ready() {
                    end.forget_answers();
                }
                received == Poll::Ready(MESSAGE)
            }
            Self::Replier(end) => {
                if let Poll::Ready(request) = end.poll_request(cx) {
                    let _gone = request.path.reply(&request.envelope, request.body);
                }
                false
            }
            Self::Requester { end, waits } if !*waits => {
                *waits = end.poll_connected(cx).is_ready() && end.request(cx, REQUEST, MESSAGE).is_ok();
                false
            }
            Self::Requester { end, waits } => match end.poll_answer(cx) {
                Poll::Ready(Answer::Reply { id, body }) => {
                    *waits = id != REQUEST;
                    id == REQUEST && body == MESSAGE
                }
                Poll::Ready(Answer::Refused { .. }) => false,
                Poll::Ready(Answer::Lost) => {
                    *waits = false;
                    false
                }
                Poll::Pending => false,
            },
        }
    }
}

/// Returns false if the peer is gone.
fn send(link: &mut dyn Link, cx: &mut Context<'_>) -> bool {
    let driven = link.drive(cx).ok();
    let is_connected = driven.is_some();
    if is_connected {
        link.send_all(cx, driven, &mut VecDeque::from([MESSAGE.into()]), &mut |_| {});
        link.request_acknowledgement(cx);
    }
    is_connected
}

/// Gives both ends turns until the message has arrived at one of them.
pub(super) async fn exchange([one, other]: [&mut End; 2]) {
    poll_fn(|cx| {
        let arrived = one.turn(cx) | other.turn(cx);
        cx.waker().wake_by_ref();
        if arrived { Poll::Ready(()) } else { Poll::Pending }
    })
    .await;
}

/// Gives an end turns until something is done, and some more for what is still on its way.
pub(super) async fn use_until(end: &mut End, done: impl Fn() -> bool) {
    let mut more = 50;
    poll_fn(|cx| {
        end.turn(cx);
        cx.waker().wake_by_ref();
        more -= usize::from(done());
        if more == 0 { Poll::Ready(()) } else { Poll::Pending }
    })
    .await;
}
