//! The publishing end of one connection: an XPUB socket of its own.
//!
//! A message is written from the caller. The library's `send` cannot be abandoned half way, so a future of its own
//! (the pump) owns the socket for good and is polled both by the caller that offers a message and by the connection's
//! task, whose waker it always gets.

use super::Medium;
use super::accepted::Accepted;
use super::frames::poll_message;
use super::listen::{Listening, listen};
use super::peers::Peers;
use crate::place::{Claim, SystemDir};
use crate::sync::lock;
use crate::transport::{Outlet, TransportError};
use bytes::Bytes;
use std::future::poll_fn;
use std::pin::Pin;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll};
use std::time::{Duration, Instant};
use zeromq::{SocketSend, XPubSocket, ZmqMessage};

/// While messages flow, how often at most it is looked whether the subscriber is still there.
const LOOK: Duration = Duration::from_millis(1);

pub(super) struct Publishing {
    desk: Arc<Mutex<Desk>>,
    pump: Pin<Box<dyn Future<Output = ()> + Send>>,
    _guard: Claim,
}

/// What the pump and its callers share.
struct Desk {
    /// A message that the pump is to send.
    outgoing: Option<Bytes>,
    /// Whether a message was taken that is not with the operating system yet.
    busy: bool,
    /// Whether the poll in progress may look for subscriptions: not when it comes from a sender, who is in a hurry.
    listening: bool,
    subscriber: bool,
}

impl Desk {
    /// Takes a message for the subscriber, if there is one; the poll that follows only sends it.
    fn put(&mut self, message: Bytes) -> Result<(), Bytes> {
        if !self.subscriber {
            return Err(message);
        }
        (self.outgoing, self.busy, self.listening) = (Some(message), true, false);
        Ok(())
    }
}

impl Publishing {
    pub(super) fn open(place: &SystemDir, medium: Medium, endpoint: &str) -> Result<Self, TransportError> {
        let Listening { socket, events, door, guard } = listen::<XPubSocket>(place, medium, endpoint)?;
        let desk = Desk { outgoing: None, busy: false, listening: false, subscriber: false };
        let desk = Arc::new(Mutex::new(desk));
        let accepted = Accepted::at(door.address());
        // Made here, because whoever is taken in before the first poll is to be disconnected with the others.
        let peers = Peers::of(&socket, events, door);
        // The task budget would refuse the write of a caller that has sent much, and nobody would come back to it.
        let pump = tokio::task::unconstrained(pump(socket, peers, accepted, Arc::clone(&desk)));
        Ok(Self { desk, pump: Box::pin(pump), _guard: guard })
    }

    fn poll_pump(&mut self, cx: &mut Context<'_>, listening: bool) {
        lock(&self.desk).listening = listening;
        let _endless = self.pump.as_mut().poll(cx);
    }

    fn is_busy(&self) -> bool {
        lock(&self.desk).busy
    }
}

impl Outlet for Publishing {
    fn drive(&mut self, cx: &mut Context<'_>) -> bool {
        self.poll_pump(cx, true);
        lock(&self.desk).subscriber
    }

    fn offer(&mut self, cx: &mut Context<'_>, message: Bytes) -> Result<(), Bytes> {
        if self.is_busy() {
            self.poll_pump(cx, false);
            if self.is_busy() {
                return Err(message);
            }
            // The pump left a send behind, during which it was deaf: the task has to listen again.
            cx.waker().wake_by_ref();
        }
        lock(&self.desk).put(message)?;
        let _endless = self.pump.as_mut().poll(cx);
        Ok(())
    }

    fn is_flushed(&self) -> bool {
        !self.is_busy()
    }
}

enum Step {
    Send(Bytes),
    Heard(Option<ZmqMessage>),
}

/// Sends what is on the desk and keeps account of who subscribed.
async fn pump(mut socket: XPubSocket, mut peers: Peers, mut accepted: Accepted, desk: Arc<Mutex<Desk>>) {
    let mut looked = Instant::now();
    loop {
        match poll_fn(|cx| next_step(&mut socket, &mut peers, &mut accepted, &desk, cx)).await {
            Step::Send(message) => {
                if let Err(error) = socket.send(message.into()).await {
                    tracing::debug!(%error, "a message could not be written");
                }
                lock(&desk).busy = false;
                if looked.elapsed() >= LOOK {
                    looked = Instant::now();
                    // A send that meets a broken connection succeeds like any other, and takes away what would have
                    // told of the break; the task finds out.
                    poll_fn(wake_again).await;
                }
            }
            Step::Heard(Some(message)) if is_subscription(&message) => {
                accepted.subscribed();
                lock(&desk).subscriber = accepted.is_anybody();
            }
            Step::Heard(_) => {}
        }
    }
}

/// Has the task polled once more.
fn wake_again(cx: &mut Context<'_>) -> Poll<()> {
    cx.waker().wake_by_ref();
    Poll::Ready(())
}

fn next_step(
    socket: &mut XPubSocket,
    peers: &mut Peers,
    accepted: &mut Accepted,
    desk: &Mutex<Desk>,
    cx: &mut Context<'_>,
) -> Poll<Step> {
    {
        let mut desk = lock(desk);
        if let Some(message) = desk.outgoing.take() {
            return Poll::Ready(Step::Send(message));
        }
        if !desk.listening {
            return Poll::Pending;
        }
    }
    match poll_message(socket, cx) {
        Poll::Ready(heard) => Poll::Ready(Step::Heard(heard.ok())),
        Poll::Pending => {
            peers.note(cx);
            let mut desk = lock(desk);
            if desk.subscriber && !accepted.any_left(peers.connected()) {
                desk.subscriber = false;
                accepted.forget();
                peers.close();
            }
            Poll::Pending
        }
    }
}

fn is_subscription(message: &ZmqMessage) -> bool {
    message.get(0).and_then(|frame| frame.first()) == Some(&1)
}
