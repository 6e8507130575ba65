//! One connection at its sending end: the link, and the queue of what the peer has not taken.

use super::GateName;
use super::holding::Holding;
use super::stats::Counts;
use crate::spec::WhenFull;
use crate::transport::Outlet;
use bytes::Bytes;
use std::collections::VecDeque;
use std::task::{Context, Poll, Waker};
use std::time::{Duration, Instant};

/// So many messages are written one by one, each from the call that sends it. If they came within [`BURST`], and the
/// runtime had no turn meanwhile, more is coming: what follows is left to the connection's task, which writes many at once.
const ONE_BY_ONE: u32 = 32;
/// Also how long messages are left to the task at most while others are sent.
const BURST: Duration = Duration::from_millis(1);

/// One connection at its sending end.
pub(crate) struct Outgoing {
    link: Box<dyn Outlet>,
    waiting: VecDeque<Bytes>,
    holding: Holding,
    present: bool,
    /// How many messages were written one by one since the task had its turn, and when that began.
    in_a_row: u32,
    began: Instant,
    /// Wakes the connection's task; senders use it too, so that whatever they leave behind is picked up there.
    task: Waker,
    /// A sender that waits for room.
    sender: Option<Waker>,
    /// A task that waits until everything is handed over.
    flusher: Option<Waker>,
    /// How often the peer has come or gone, and a task that waits for the next time.
    changes: u64,
    watcher: Option<Waker>,
    counts: Counts,
    dropping: bool,
    gate: GateName,
    peer: String,
}

impl Outgoing {
    pub(crate) fn new(link: Box<dyn Outlet>, holding: Holding, gate: GateName, peer: String) -> Self {
        Self {
            link,
            waiting: VecDeque::new(),
            holding,
            present: false,
            in_a_row: 0,
            began: Instant::now(),
            task: Waker::noop().clone(),
            sender: None,
            flusher: None,
            changes: 0,
            watcher: None,
            counts: Counts::default(),
            dropping: false,
            gate,
            peer,
        }
    }

    /// Moves on; called by the connection's task whenever it is woken.
    pub(crate) fn drive(&mut self, cx: &mut Context<'_>) {
        if !self.task.will_wake(cx.waker()) {
            self.task = cx.waker().clone();
        }
        let present = self.link.drive(cx);
        if present != self.present {
            self.present = present;
            self.changes += 1;
            if let Some(watcher) = self.watcher.take() {
                watcher.wake();
            }
            let (gate, peer) = (self.gate, &self.peer);
            tracing::debug!(%gate, peer, "{}", if present { "connected" } else { "disconnected" });
        }
        let waited = self.waiting.len();
        self.hand_over();
        let together = waited - self.waiting.len();
        self.in_a_row = 0;
        if together >= ONE_BY_ONE as usize {
            // There is likely more of the burst to come: then one message is enough to see that.
            (self.in_a_row, self.began) = (ONE_BY_ONE - 1, Instant::now());
        }
    }

    /// Takes a message without waiting; a full queue treats it as declared.
    pub(crate) fn send(&mut self, message: Bytes) {
        let too_long = self.is_burst() && self.began.elapsed() >= BURST;
        if too_long || !self.has_room() {
            self.hand_over();
        }
        if too_long {
            self.in_a_row = 0;
        }
        let message = match self.try_link(message) {
            Ok(()) => return,
            Err(message) => message,
        };
        let kept = self.present || self.holding.for_absent;
        if kept && (self.has_room() || self.make_room()) {
            self.waiting.push_back(message);
        }
    }

    /// Ready when a message would find room, or would not have to wait for it.
    pub(crate) fn poll_room(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        if self.makes_wait() {
            self.hand_over();
        }
        if !self.makes_wait() {
            return Poll::Ready(());
        }
        self.sender = Some(cx.waker().clone());
        Poll::Pending
    }

    /// Whether one more message would have to wait.
    pub(crate) fn makes_wait(&self) -> bool {
        let waits = self.holding.when_full == WhenFull::Wait && (self.present || self.holding.wait_for_absent);
        waits && !self.has_room()
    }

    /// Whether one more message would find room.
    pub(crate) fn has_room(&self) -> bool {
        self.waiting.len() < self.holding.capacity
    }

    /// Whether nothing waits that the peer, if it is there, could still be given.
    pub(crate) fn is_flushed(&self) -> bool {
        !self.present || (self.waiting.is_empty() && self.link.is_flushed())
    }

    /// Wakes a task when the queue has moved on; it then asks [`Self::is_flushed`] again.
    pub(crate) fn wake_when_flushed(&mut self, waker: &Waker) {
        self.flusher = Some(waker.clone());
    }

    /// How often the peer has come or gone so far; the task is woken when that is no longer true.
    pub(crate) fn watch_changes(&mut self, waker: &Waker) -> u64 {
        self.watcher = Some(waker.clone());
        self.changes
    }

    pub(crate) fn is_connected(&self) -> bool {
        self.present
    }

    /// Whether a message would go out at once.
    pub(crate) fn is_free(&self) -> bool {
        self.present && self.waiting.is_empty()
    }

    pub(crate) fn waiting(&self) -> usize {
        self.waiting.len()
    }

    pub(crate) fn counts(&self) -> &Counts {
        &self.counts
    }

    fn try_link(&mut self, message: Bytes) -> Result<(), Bytes> {
        if !self.present || !self.waiting.is_empty() || self.is_burst() {
            return Err(message);
        }
        let size = message.len();
        self.link.offer(&mut Context::from_waker(&self.task), message)?;
        self.counts.moved(size);
        if self.in_a_row == 0 {
            self.began = Instant::now();
        }
        self.in_a_row += 1;
        if self.is_burst() {
            self.task.wake_by_ref();
            if self.began.elapsed() >= BURST {
                self.in_a_row = 0;
            }
        }
        Ok(())
    }

    /// Whether what is sent now is left to the task.
    fn is_burst(&self) -> bool {
        self.in_a_row >= ONE_BY_ONE
    }

    /// Gives the link what waits, in order, as far as it takes it.
    fn hand_over(&mut self) {
        if self.present && !self.waiting.is_empty() {
            let (counts, mut cx) = (&mut self.counts, Context::from_waker(&self.task));
            self.link.offer_all(&mut cx, &mut self.waiting, &mut |size| counts.moved(size));
        }
        self.dropping &= !self.waiting.is_empty();
        if self.is_flushed()
            && let Some(flusher) = self.flusher.take()
        {
            flusher.wake();
        }
        // There is room, or the peer that it would wait for is an optional one that has gone.
        if !self.makes_wait()
            && let Some(sender) = self.sender.take()
        {
            sender.wake();
        }
    }

    /// Whether the new message has a place now.
    fn make_room(&mut self) -> bool {
        let newest = self.holding.when_full == WhenFull::DropNewest;
        if !newest {
            self.waiting.pop_front();
        }
        self.counts.dropped(newest);
        // With a queue of one, replacing the old value by the new is what was asked for, and nothing to warn about.
        if !self.dropping && self.holding.capacity > 1 {
            self.dropping = true;
            let (gate, peer, queue) = (self.gate, &self.peer, self.holding.capacity);
            let reason = if self.present { "is too slow" } else { "is not there" };
            tracing::warn!(%gate, queue, "`{peer}` {reason}: its queue is full, messages are dropped");
        }
        !newest
    }
}
