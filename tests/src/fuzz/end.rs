//! An end of the `zeromq` transport, used as its gate would use it.

use scl::bytes::Bytes;
use scl::transport::zeromq::ZeroMq;
use scl::transport::{Answer, Answerer, Asker, Inlet, Outlet, Transport, TransportError};
use std::future::poll_fn;
use std::task::{Context, Poll};

pub(super) const ENDPOINT: &str = "a.out--b.in.1a2b3c4d";

/// What good peers say to each other.
const WORD: Bytes = Bytes::from_static(b"a word among good peers");
const NUMBER: u64 = 0x0101_0101_0101_0101;

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

    /// The kind of socket that this role has on the wire.
    pub(super) fn kind(self) -> &'static [u8] {
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
    Outlet(Box<dyn Outlet>),
    Inlet(Box<dyn Inlet>),
    Answerer(Box<dyn Answerer>),
    /// With whether it waits for an answer.
    Asker(Box<dyn Asker>, bool),
}

impl End {
    pub(super) fn open(role: Role, transport: &ZeroMq) -> Result<Self, TransportError> {
        Ok(match role {
            Role::Publish => Self::Outlet(transport.publish(ENDPOINT)?),
            Role::Push => Self::Outlet(transport.push(ENDPOINT)?),
            Role::Subscribe => Self::Inlet(transport.subscribe(ENDPOINT)?),
            Role::Pull => Self::Inlet(transport.pull(ENDPOINT)?),
            Role::Reply => Self::Answerer(transport.reply(ENDPOINT)?),
            Role::Request => Self::Asker(transport.request(ENDPOINT)?, false),
        })
    }

    /// Sends the word to who is there, takes what has come, answers what is asked. Says whether the word came.
    fn turn(&mut self, cx: &mut Context<'_>) -> bool {
        match self {
            Self::Outlet(end) => {
                end.drive(cx);
                let _nobody_takes_it = end.offer(cx, WORD);
                false
            }
            Self::Inlet(end) => match end.poll_recv(cx) {
                Poll::Ready(message) => message == WORD,
                Poll::Pending => false,
            },
            Self::Answerer(end) => {
                if let Poll::Ready(asked) = end.poll_asked(cx) {
                    let _gone = asked.responder.respond(asked.body);
                }
                false
            }
            Self::Asker(end, waits) if !*waits => {
                *waits = end.poll_connected(cx).is_ready() && end.ask(NUMBER, WORD).is_ok();
                false
            }
            Self::Asker(end, waits) => match end.poll_answer(cx) {
                Poll::Ready(Answer::Reply { id, body }) => {
                    *waits = id != NUMBER;
                    id == NUMBER && body == WORD
                }
                Poll::Ready(Answer::Lost) => {
                    *waits = false;
                    false
                }
                Poll::Pending => false,
            },
        }
    }
}

/// Gives each end its turn again and again, until the word has come to one of them.
pub(super) async fn exchange(ends: [&mut End; 2]) {
    let [one, other] = ends;
    poll_fn(|cx| {
        let arrived = one.turn(cx) | other.turn(cx);
        cx.waker().wake_by_ref();
        if arrived { Poll::Ready(()) } else { Poll::Pending }
    })
    .await;
}

/// Gives an end its turns until something is done, and a few more for what is still on its way.
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
