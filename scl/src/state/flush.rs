//! Hands over the messages left when a gate is dropped, a component is closed, or a program ends.

use crate::error::Unflushed;
use crate::sync::lock;
use std::future::poll_fn;
use std::pin::pin;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};
use std::thread;
use std::time::{Duration, Instant};

/// How long a gate or component that is dropped, or a program that ends, waits for its peers.
pub(crate) const LINGER: Duration = Duration::from_secs(1);
/// How often a flush checks whether an absent peer is still running.
const LOOK: Duration = Duration::from_millis(20);
/// The pause between two attempts of a component that is dropped, which has no runtime to be woken by.
const PAUSE: Duration = Duration::from_micros(500);

/// Which peers a flush waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Flush {
    /// Peers that are connected. For programs after a stop request: their peers may be stopping, too.
    Connected,
    /// Peers that are connected, and those that are running but not connected yet.
    Running,
}

/// The end of a gate that sends.
pub(crate) trait SendingEnd: Send {
    /// Ready when connected peers have everything: it is written, and, if `acknowledged`, the peer's program has taken
    /// it. Wakes the task when that may have changed.
    fn poll_flushed(&mut self, acknowledged: bool, cx: &mut Context<'_>) -> Poll<()>;

    /// Returns what waits for a peer that is not connected.
    fn waits_for_absent_peer(&self) -> Option<Unflushed>;

    /// Returns what a connected peer has not taken.
    fn leftover(&self, acknowledged: bool) -> Option<Unflushed>;

    /// Does background work.
    fn drive(&mut self, cx: &mut Context<'_>);

    /// Writes what was held back to be written together with later messages. Returns false if something is left.
    fn write_out(&mut self) -> bool;

    /// Prepares for `drive` without a runtime.
    fn detach(&mut self);

    /// Wakes the call that waits to send, if there is one.
    fn wake_call(&mut self) {}

    /// Returns true if a call waits to send.
    fn call_waits(&self) -> bool {
        false
    }
}

/// The ends of a gate that receives.
pub(crate) trait ReceivingEnd: Send {
    /// Tells the senders what the program has received, because it is about to end.
    fn acknowledge_last(&mut self);
}

type Ends = [Arc<Mutex<dyn SendingEnd>>];

/// Waits until peers have taken everything, at most for a given time. Returns what they did not take, and what waits
/// for peers that are not running.
pub(super) async fn flush(
    ends: &Ends,
    flush: Flush,
    timeout: Duration,
    is_running: &(dyn Fn(&str) -> bool + Sync),
) -> Vec<Unflushed> {
    let mut deadline = pin!(tokio::time::sleep(timeout));
    let mut look = pin!(tokio::time::sleep(LOOK));
    poll_fn(|cx| {
        let (mut is_open, mut awaits) = (false, false);
        // Poll all of them, so that each wakes this task.
        for end in ends {
            // Locked once for both questions: a peer that connects in between would count neither as absent nor as one
            // that has not taken everything.
            let mut end = lock(end);
            is_open |= end.poll_flushed(true, cx).is_pending();
            let absent = end.waits_for_absent_peer().filter(|_| flush == Flush::Running);
            awaits |= absent.is_some_and(|left| is_running(left.peer.component()));
        }
        if !is_open && !awaits {
            return Poll::Ready(());
        }
        // Check periodically, because a peer that dies before it connects causes no event.
        while awaits && look.as_mut().poll(cx).is_ready() {
            look.as_mut().reset(tokio::time::Instant::now() + LOOK);
        }
        deadline.as_mut().poll(cx)
    })
    .await;
    leftovers(ends, flush, true)
}

/// Like [`flush`], but on the calling thread, without a runtime. The ends cannot be used for anything else afterwards.
pub(super) fn flush_detached(
    ends: &Ends,
    flush: Flush,
    acknowledged: bool,
    timeout: Duration,
    is_running: &dyn Fn(&str) -> bool,
) -> Vec<Unflushed> {
    // Do this first: the runtime that the ends were opened on may have ended and must not be used.
    ends.iter().for_each(|end| lock(end).detach());
    let cx = &mut Context::from_waker(Waker::noop());
    let mut is_done = |end: &Arc<Mutex<dyn SendingEnd>>| {
        let mut end = lock(end);
        let awaited = |left: Unflushed| flush == Flush::Running && is_running(left.peer.component());
        end.poll_flushed(acknowledged, cx).is_ready() && !end.waits_for_absent_peer().is_some_and(awaited)
    };
    let mut open: Vec<_> = ends.iter().filter(|end| !is_done(end)).collect();
    let started = Instant::now();
    while !open.is_empty() && started.elapsed() < timeout {
        open.iter().for_each(|end| lock(end).drive(&mut Context::from_waker(Waker::noop())));
        open.retain(|end| !is_done(end));
        if !open.is_empty() {
            thread::sleep(PAUSE);
        }
    }
    leftovers(ends, flush, acknowledged)
}

fn leftovers(ends: &Ends, flush: Flush, acknowledged: bool) -> Vec<Unflushed> {
    ends.iter().filter_map(|end| leftover(&mut *lock(end), flush, acknowledged)).collect()
}

/// Returns what a connected peer did not take, or what waits for a peer that is not connected.
pub(super) fn leftover(end: &mut dyn SendingEnd, flush: Flush, acknowledged: bool) -> Option<Unflushed> {
    end.leftover(acknowledged).or_else(|| end.waits_for_absent_peer().filter(|_| flush == Flush::Running))
}
