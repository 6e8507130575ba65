//! The pushing end: a PUSH socket, kept from queueing by itself.
//!
//! The library queues up to 100,000 messages a peer and tells nobody how many wait. But it drops a message's bytes as
//! it writes them, so each message carries a token that counts itself out when dropped, and no more than
//! [`MOST_MESSAGES`] or [`MOST_BYTES`] are with the library at a time.
//!
//! And since a PUSH socket never reads, the library would notice a lost puller only by a message that is lost with it: a
//! second connection to the same puller, which only listens, tells in time.

use super::dial::{Dials, Probe};
use super::line::Line;
use super::zmtp::hello;
use crate::place::SystemDir;
use crate::sync::lock;
use crate::transport::Outlet;
use bytes::Bytes;
use std::pin::Pin;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};
use zeromq::{PushSocket, SocketSend};

/// As many as the library writes at once.
const MOST_MESSAGES: usize = 128;
/// Few enough to keep the file's promise about memory. A longer message goes to the library alone.
const MOST_BYTES: usize = 256 * 1024;

pub(super) struct Pushing {
    line: Line<PushSocket>,
    peer_ended: Option<Pin<Box<dyn Future<Output = ()> + Send>>>,
    window: Arc<Window>,
}

impl Pushing {
    pub(super) fn open(place: &Arc<SystemDir>, endpoint: &str) -> Self {
        Self { line: Line::open(place, endpoint), peer_ended: None, window: Arc::default() }
    }

    /// Whether the connection in use has just broken.
    fn poll_lost(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let Poll::Ready(dialled) = self.line.poll_dialled(cx) else { return Poll::Pending };
        if let Some(probe) = dialled.probe.take() {
            self.peer_ended = Some(Box::pin(tokio::task::unconstrained(ended(probe))));
        }
        let ended = self.peer_ended.as_mut().is_some_and(|ended| ended.as_mut().poll(cx).is_ready());
        if ended { Poll::Ready(()) } else { dialled.poll_lost(cx) }
    }
}

/// Returns when the puller is gone.
async fn ended(mut probe: Probe) {
    // It introduces itself, because a connection that stays silent may be closed by the puller, or never.
    if probe.say(&hello("PUSH")).await.is_ok() {
        probe.ended().await;
    }
}

impl Dials for PushSocket {
    type End = Self;
    const KEEPS_PROBE: bool = true;

    fn into_end(self) -> Self {
        self
    }
}

impl Outlet for Pushing {
    fn drive(&mut self, cx: &mut Context<'_>) -> bool {
        while self.poll_lost(cx).is_ready() {
            self.line.lost();
            self.peer_ended = None;
        }
        self.window.watch(cx);
        self.line.poll_dialled(cx).is_ready()
    }

    fn offer(&mut self, cx: &mut Context<'_>, message: Bytes) -> Result<(), Bytes> {
        let Poll::Ready(dialled) = self.line.poll_dialled(cx) else { return Err(message) };
        if self.window.is_full(message.len()) {
            return Err(message);
        }
        let counted = Bytes::from_owner(Counted::new(message.clone(), &self.window));
        // The library only queues here; its writer runs as a task of its own.
        match dialled.end.send(counted.into()).as_mut().poll(cx) {
            Poll::Ready(Ok(())) => Ok(()),
            Poll::Ready(Err(_)) | Poll::Pending => {
                cx.waker().wake_by_ref();
                Err(message)
            }
        }
    }

    fn is_flushed(&self) -> bool {
        lock(&self.window.state).messages == 0
    }
}

/// How many messages are with the library.
#[derive(Debug, Default)]
struct Window {
    state: Mutex<Outstanding>,
}

#[derive(Debug, Default)]
struct Outstanding {
    messages: usize,
    bytes: usize,
    waiting: Option<Waker>,
}

impl Outstanding {
    fn count_in(&mut self, length: usize) {
        self.messages += 1;
        self.bytes += length;
    }

    fn count_out(&mut self, length: usize) {
        self.messages -= 1;
        self.bytes -= length;
    }

    fn is_half_empty(&self) -> bool {
        self.messages <= MOST_MESSAGES / 2 && self.bytes <= MOST_BYTES / 2
    }
}

impl Window {
    /// Whether a message of a length would be too much.
    fn is_full(&self, length: usize) -> bool {
        let state = lock(&self.state);
        state.messages >= MOST_MESSAGES || (state.messages > 0 && state.bytes + length > MOST_BYTES)
    }

    fn watch(&self, cx: &Context<'_>) {
        let mut state = lock(&self.state);
        if !state.waiting.as_ref().is_some_and(|waiting| waiting.will_wake(cx.waker())) {
            state.waiting = Some(cx.waker().clone());
        }
    }
}

/// A message that counts itself out when its bytes are dropped.
struct Counted {
    bytes: Bytes,
    window: Arc<Window>,
}

impl Counted {
    fn new(bytes: Bytes, window: &Arc<Window>) -> Self {
        lock(&window.state).count_in(bytes.len());
        Self { bytes, window: Arc::clone(window) }
    }
}

impl AsRef<[u8]> for Counted {
    fn as_ref(&self) -> &[u8] {
        &self.bytes
    }
}

impl Drop for Counted {
    fn drop(&mut self) {
        let mut state = lock(&self.window.state);
        let before = state.is_half_empty();
        state.count_out(self.bytes.len());
        // Woken when the window is half empty, so that the library gets several messages at once.
        if (before != state.is_half_empty() || state.messages == 0)
            && let Some(waker) = &state.waiting
        {
            waker.wake_by_ref();
        }
    }
}
