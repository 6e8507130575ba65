//! One connection at its sending end: the link to the peer, and the queue of what the peer has not taken.
//!
//! ```text
//!              a component connects                  the gate is dropped
//! Absent ───────────────────────────▶ Connected ─────────────────────────▶ Detached: no runtime; sends what
//!    ▲  messages wait, up to the          │ sends in order; what the link    waits, without regard to credit,
//!    │  queue; plain ZeroMQ programs      │ cannot take waits                until its peers have everything
//!    │  may take them in its place        │
//!    └────────────────────────────────────┘
//!       it disconnects, or a newer program of the component replaces it:
//!       what it had not received is lost
//! ```

mod account;
mod flush;

use super::foreign::{Counts, ForeignPeer};
use super::latch::Latch;
use super::queue::{Pushed, Queue, QueuePolicy};
use crate::error::{GateName, Missing, PeerName};
use crate::registry::EndCheck;
use crate::spec::{ConnectionSpec, GateKind, GateSpec, WhenFull};
use crate::state::Changes;
use crate::transport::{Disconnected, Driven, Frame, Link, Loan, Peer, PeerKind, Sender, Sent};
use account::Account;
use std::collections::VecDeque;
use std::task::{Context, Poll, Waker};
use std::time::{Duration, Instant};

/// One connection at its sending end.
pub(crate) struct Connection {
    sender: Box<dyn Sender>,
    /// The link to the component at the other end.
    peer: Option<Box<dyn Link>>,
    /// Messages that wait for that component, whether it is connected or not.
    queue: Queue<Frame>,
    /// Plain ZeroMQ subscribers beside it or in its place.
    foreign: Vec<ForeignPeer>,
    /// Counts of the plain ZeroMQ subscribers that have disconnected.
    foreign_left: Counts,
    /// Wakes the connection's task; senders pass it to the link too, so that the task continues what they leave behind.
    task: Waker,
    waiting_sender: Option<Waker>,
    /// Wakers of pending flushes: a dropped gate and the component's flush may both wait.
    waiting_flushes: Vec<Waker>,
    watcher: Option<Waker>,
    /// Number of connects and disconnects so far.
    changes: u64,
    /// The state that was last reported: whether the peer was connected, and the number of plain ZeroMQ subscribers.
    reported: (bool, usize),
    account: Account,
    /// The last message, if the gate has `latched: true`.
    latch: Option<Latch>,
    /// Whether the queue has been dropping messages since it was last empty.
    dropping: bool,
    detached: bool,
    gate: GateName,
    kind: GateKind,
    link: &'static ConnectionSpec,
    component_changes: Changes,
    has_ended: Option<EndCheck>,
}

impl Connection {
    pub(crate) fn new(
        sender: Box<dyn Sender>,
        gate: GateName,
        spec: &'static GateSpec,
        link: &'static ConnectionSpec,
        component_changes: Changes,
        has_ended: Option<EndCheck>,
    ) -> Self {
        let queue = Queue::new(policy(spec, link));
        Self {
            sender,
            peer: None,
            queue: if link.max_age.is_some() { queue.timed() } else { queue },
            foreign: Vec::new(),
            foreign_left: Counts::default(),
            task: Waker::noop().clone(),
            waiting_sender: None,
            waiting_flushes: Vec::new(),
            watcher: None,
            changes: 0,
            reported: (false, 0),
            account: Account::default(),
            latch: spec.options.latched.then(Latch::default),
            dropping: false,
            detached: false,
            gate,
            kind: spec.kind,
            link,
            component_changes,
            has_ended,
        }
    }

    /// Does background work; called by the connection's task whenever it is woken.
    pub(crate) fn drive(&mut self, cx: &mut Context<'_>) {
        self.task.clone_from(cx.waker());
        let driven = self.accept_and_read(cx);
        self.hand_over(driven);
        // Includes disconnects that sending calls have noticed since the last drive.
        let connected = (self.peer.is_some(), self.foreign.len());
        if std::mem::replace(&mut self.reported, connected) != connected {
            self.report_change();
        }
    }

    /// Sends or queues a message without waiting. If the queue is full, its declared policy applies.
    pub(crate) fn send(&mut self, message: Frame) {
        if let Some(latch) = &mut self.latch {
            latch.keep(&message);
        }
        self.account.published += 1;
        let mut cx = Context::from_waker(&self.task);
        if !self.foreign.is_empty() {
            let shared = message.to_bytes();
            self.foreign.iter_mut().for_each(|peer| peer.send(&mut cx, shared.clone()));
        }
        // Before dropping a message, try to hand some over.
        let driven = if self.queue.is_full() { self.drive_peer() } else { None };
        if !self.queue.is_empty() {
            self.hand_over(driven);
        }
        match &mut self.peer {
            Some(link) if self.queue.is_empty() => {
                let length = message.len();
                let cx = &mut Context::from_waker(&self.task);
                let sent = match self.link.max_age {
                    None => link.send(cx, message),
                    Some(_) => link.send_timed(cx, message, Instant::now()),
                };
                match sent {
                    Sent::Sent => self.account.hand(length),
                    Sent::Full(message) | Sent::Deferred(message) | Sent::Gone(message) => self.keep(message),
                }
            }
            _ => self.keep(message),
        }
        self.check_account();
    }

    /// Lends memory of the link to the peer, to be filled and sent without a copy.
    pub(crate) fn loan(&mut self, length: usize) -> Option<Loan> {
        self.peer.as_mut()?.loan(length)
    }

    /// The peer, if it is required and not connected.
    pub(crate) fn missing(&self) -> Option<Missing> {
        let is_missing = self.link.required && !self.is_connected();
        is_missing.then(|| Missing { connection: self.link, refusal: self.sender.refusal() })
    }

    /// Ready when one more message would not have to wait.
    pub(crate) fn poll_room(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        if self.would_wait() {
            self.hand_over(None);
        }
        if !self.would_wait() {
            return Poll::Ready(());
        }
        self.waiting_sender = Some(cx.waker().clone());
        Poll::Pending
    }

    /// Returns true if one more message would have to wait.
    pub(crate) fn would_wait(&self) -> bool {
        if !self.queue.waits() {
            return false;
        }
        if self.peer.is_none() && !self.foreign.is_empty() {
            return self.foreign.iter().any(ForeignPeer::is_full);
        }
        self.queue.is_full() && (self.peer.is_some() || self.link.required)
    }

    /// Returns true if one more message would find room.
    pub(crate) fn has_room(&self) -> bool {
        !self.queue.is_full()
    }

    /// Returns true if a message would be written at once.
    pub(crate) fn is_free(&self) -> bool {
        self.peer.is_some() && self.queue.is_empty()
    }

    /// Returns true if the component at the other end is connected, or a plain ZeroMQ program in its place.
    pub(crate) fn is_connected(&self) -> bool {
        self.peer.is_some() || !self.foreign.is_empty()
    }

    /// Number of connects and disconnects so far. Wakes the task when it changes.
    pub(crate) fn watch_changes(&mut self, waker: &Waker) -> u64 {
        self.watcher = Some(waker.clone());
        self.changes
    }

    pub(crate) fn peer_name(&self) -> PeerName {
        PeerName::of(self.link)
    }

    fn accept_and_read(&mut self, cx: &mut Context<'_>) -> Option<Driven> {
        let driven = loop {
            while let Poll::Ready(peer) = self.sender.poll_peer(cx) {
                self.adopt(peer);
            }
            match self.peer.as_mut().map(|link| link.drive(cx)).transpose() {
                Ok(driven) => break driven,
                Err(Disconnected) => self.disconnect(),
            }
        };
        let left = &mut self.foreign_left;
        self.foreign.retain_mut(|peer| {
            let stays = peer.drive(cx).is_ok();
            if !stays {
                *left = left.plus(peer.counts());
            }
            stays
        });
        driven
    }

    /// Drives the link in a call that sends. The task accepts another peer if this one is gone.
    fn drive_peer(&mut self) -> Option<Driven> {
        let driven = self.peer.as_mut()?.drive(&mut Context::from_waker(&self.task)).ok();
        if driven.is_none() {
            self.disconnect();
            self.task.wake_by_ref();
        }
        driven
    }

    fn adopt(&mut self, Peer { kind, mut link }: Peer) {
        if self.detached {
            link.detach();
        }
        if kind == PeerKind::Foreign && self.kind == GateKind::Pub {
            let policy = self.queue.policy;
            // The queued messages must stay for the component, which may still connect, so a foreign peer gets copies.
            let copy = |frame: &mut Frame| Frame::from(frame.make_bytes().clone());
            let mut waiting = match self.peer {
                None => self.queue.parts_mut().0.iter_mut().map(copy).collect(),
                Some(_) => VecDeque::new(),
            };
            self.latch.iter().for_each(|latch| latch.join_foreign(&mut waiting));
            self.foreign.push(ForeignPeer::new(link, policy, waiting, self.latch.is_some()));
            return;
        }
        // A newer link replaces an older one: only one program at a time runs a component.
        self.disconnect();
        if let Some(latch) = &mut self.latch {
            let again = latch.join(&mut self.queue, link.resumed(), self.account.handed);
            self.account.latched += u64::from(again);
        }
        self.peer = Some(link);
    }

    fn disconnect(&mut self) {
        if let Some(mut link) = self.peer.take() {
            link.read_last();
            self.account.lost += link.not_received();
            self.latch.iter_mut().for_each(|latch| latch.leave(self.account.handed));
        }
    }

    /// Hands the link the messages that wait, in order, as many as it takes. Wakes pending flushes, and the sender if
    /// it need not wait any more.
    fn hand_over(&mut self, driven: Option<Driven>) {
        let mut cx = Context::from_waker(&self.task);
        let account = &mut self.account;
        if let Some(link) = &mut self.peer {
            let joined = self.latch.as_ref().and_then(|latch| latch.take_joined(&mut self.queue));
            let mut sent = |length| account.hand(length);
            match self.queue.parts_mut() {
                (items, None) => link.send_all(&mut cx, driven, items, &mut sent),
                (items, Some(times)) => link.send_all_timed(&mut cx, driven, items, times, &mut sent),
            }
            if let (Some(joined), Some(latch)) = (joined, &mut self.latch) {
                send_joined(&mut **link, latch, &mut self.queue, account, joined, &mut cx);
            }
        }
        self.dropping &= !self.queue.is_empty();
        // Wake flushes even if the queue has not changed: they also wait for acknowledgements.
        self.waiting_flushes.drain(..).for_each(Waker::wake);
        // Wake the sender if there is room, or if the peer was optional and has disconnected.
        if self.waiting_sender.is_some() && !self.would_wait() {
            self.waiting_sender.take().into_iter().for_each(Waker::wake);
        }
    }

    /// Queues a message for the component at the other end.
    fn keep(&mut self, message: Frame) {
        if self.peer.is_none() && !self.foreign.is_empty() {
            // A foreign peer was already given the message, so older ones can make room without a loss.
            let pushed = self.queue.replace(message);
            let handed = u64::from(pushed != Pushed::Stored);
            self.account.handed += handed;
            self.account.in_place += handed;
            return self.note_queued(pushed);
        }
        let pushed = self.queue.push(message);
        self.note_queued(pushed);
        if pushed != Pushed::Stored && !self.dropping && !self.queue.policy.newest_only() {
            self.dropping = true;
            let (gate, queue) = (self.gate, self.queue.policy.capacity);
            let reason = if self.peer.is_some() { "it reads too slowly" } else { "it is not connected" };
            if self.has_completed() {
                tracing::debug!(%gate, queue, "queue of {} is full; dropping messages: it has ended", self.peer_name());
            } else {
                tracing::warn!(%gate, queue, "queue of {} is full; dropping messages: {reason}", self.peer_name());
            }
        }
    }

    /// Returns true if the peer was connected and has ended in order, so that it needs no more messages.
    fn has_completed(&self) -> bool {
        self.peer.is_none() && self.changes > 0 && self.has_ended.as_ref().is_some_and(|has_ended| has_ended())
    }

    fn note_queued(&mut self, pushed: Pushed) {
        self.latch.iter_mut().for_each(|latch| latch.note_queued(pushed));
    }

    fn report_change(&mut self) {
        self.changes += 1;
        self.watcher.take().into_iter().for_each(Waker::wake);
        self.component_changes.report();
        let (gate, foreign) = (self.gate, self.foreign.len());
        let state = if self.peer.is_some() { "connected" } else { "disconnected" };
        tracing::debug!(%gate, foreign, "{} is {state}", self.peer_name());
    }
}

/// Sends a latched message that is older than the link, with its age, once those before it are sent; otherwise returns
/// it to the queue.
fn send_joined(
    link: &mut dyn Link,
    latch: &mut Latch,
    queue: &mut Queue<Frame>,
    account: &mut Account,
    (message, age): (Frame, Duration),
    cx: &mut Context<'_>,
) {
    let length = message.len();
    let returned = if queue.is_empty() { link.send_latched(cx, message, age).returned() } else { Some(message) };
    match returned {
        None => {
            account.hand(length);
            latch.note_sent();
        }
        Some(message) => queue.push_back(message),
    }
}

/// Returns the policy of the receiving gate's queue. It makes the sender wait only if the sending gate allows that.
fn policy(spec: &GateSpec, link: &ConnectionSpec) -> QueuePolicy {
    let may_wait = spec.options.backpressure || link.when_full != WhenFull::Wait;
    let when_full = if may_wait { link.when_full } else { WhenFull::DropOldest };
    QueuePolicy { capacity: link.queue as usize, when_full }
}
