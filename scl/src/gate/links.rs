//! The links of a receiving gate, polled in turn for messages.

use super::due::Due;
use super::io_waker::{Drained, IoWaker};
use crate::error::Missing;
use crate::runtime_dir::GateFigures;
use crate::spec::GateSpec;
use crate::state::Changes;
use crate::transport::Receiver;
use bytes::Bytes;
use std::sync::Arc;
use std::task::{Context, Poll, Waker};
use std::time::{Duration, Instant};

/// One link per peer, or one for all peers of a gate that listens.
pub(super) struct Links {
    links: Vec<Link>,
    /// The link to poll first, so that each gets its turn.
    next: usize,
    drained: Drained,
    waker: Waker,
    changes: Changes,
    /// Whether the program gets only messages that are not too old.
    is_timed: bool,
}

struct Link {
    end: Box<dyn Receiver>,
    /// Number of connected peers when it was asked last.
    peers: usize,
    /// Whether its sender keeps its last message for subscribers that join.
    is_latched: bool,
    /// Number of messages that it has returned.
    received: u64,
    /// How many of them wait in the gate's queue.
    waiting: u64,
    /// Whether a sender waits for a report of each message that leaves the queue.
    is_awaited: bool,
    /// When the next message is due, of a gate with a deadline.
    due: Option<Due>,
    /// Whether nothing is due while no peer is connected.
    is_optional: bool,
    /// Number of messages that were too old when the program was to receive them.
    expired: u64,
}

/// A message and the link that it came from.
pub(super) struct Arrived {
    pub(super) link: usize,
    pub(super) frame: Bytes,
    /// When it was sent, if that was before this gate had joined, or if the gate has a greatest age. A sender that does
    /// not tell has sent it when it arrived.
    pub(super) sent: Option<Instant>,
    /// Whether it was sent before this gate had joined.
    pub(super) is_latched: bool,
}

impl Links {
    /// Creates the links. `io` is woken when it is worth polling them again.
    pub(super) fn new(spec: &GateSpec, ends: Vec<Box<dyn Receiver>>, io: Arc<IoWaker>, changes: Changes) -> Self {
        let listens = !spec.endpoint.is_empty();
        let to_link = |(number, end): (usize, Box<dyn Receiver>)| Link {
            end,
            peers: 0,
            is_latched: false,
            received: 0,
            waiting: 0,
            is_awaited: false,
            due: spec.options.deadline.map(Due::needed),
            expired: 0,
            is_optional: match listens {
                true => spec.connections.iter().all(|connection| !connection.required),
                false => spec.connections.get(number).is_some_and(|connection| !connection.required),
            },
        };
        let links = ends.into_iter().enumerate().map(to_link).collect();
        let waker = Waker::from(Arc::clone(&io));
        let is_timed = spec.options.max_age.is_some();
        Self { links, next: 0, drained: Drained::new(io), waker, changes, is_timed }
    }

    pub(super) fn len(&self) -> usize {
        self.links.len()
    }

    /// Returns false if all links had nothing when they were last polled, and nothing has arrived since.
    pub(super) fn may_have_more(&mut self) -> bool {
        !self.drained.still_holds()
    }

    /// Makes the next [`poll_next`](Self::poll_next) poll all links, even if they had nothing.
    pub(super) fn look_again(&mut self) {
        self.drained.reset();
    }

    /// Makes [`poll_next`](Self::poll_next) poll no link before an event.
    pub(super) fn rest(&mut self) {
        self.drained.set();
    }

    /// Returns the next message, if one has arrived.
    pub(super) fn poll_next(&mut self) -> Poll<Arrived> {
        if !self.may_have_more() {
            return Poll::Pending;
        }
        let cx = &mut Context::from_waker(&self.waker);
        let count = self.links.len();
        for offset in 0..count {
            let number = (self.next + offset) % count;
            let link = &mut self.links[number];
            let polled = link.end.poll_recv(cx);
            link.report_peers(&self.changes);
            if let Poll::Ready(frame) = polled {
                self.next = (number + 1) % count;
                link.received += 1;
                if let Some(due) = &mut link.due {
                    due.add(Instant::now());
                }
                let latched = if link.is_latched { link.end.take_latched() } else { None };
                let sent = match latched {
                    None if self.is_timed => Some(link.end.take_sent().unwrap_or_else(Instant::now)),
                    latched => latched,
                };
                return Poll::Ready(Arrived { link: number, frame, sent, is_latched: latched.is_some() });
            }
        }
        self.drained.set();
        Poll::Pending
    }

    /// Lets the links connect, and takes no messages from them before an event, because the queue has no room.
    pub(super) fn connect(&mut self) {
        self.rest();
        let cx = &mut Context::from_waker(&self.waker);
        for link in &mut self.links {
            link.end.connect(cx);
            link.report_peers(&self.changes);
        }
    }

    /// Has the links polled again after other tasks had their turn.
    pub(super) fn ask_later(&mut self) {
        self.drained.reset();
        self.waker.wake_by_ref();
    }

    /// Fetches messages from the operating system directly, because the runtime may not have had a turn for long.
    pub(super) fn fetch(&mut self, within: Duration) {
        self.drained.reset();
        self.links.iter_mut().for_each(|link| link.end.catch_up(within));
    }

    /// Waits for the only link on the calling thread. Returns true if something has arrived.
    pub(super) fn wait(&mut self, within: Duration) -> bool {
        self.drained.reset();
        self.links.first_mut().is_some_and(|link| link.end.wait(within))
    }

    /// Discards the senders' earlier answers, which do not count for a call that begins now.
    pub(super) fn forget_answers(&mut self) {
        self.links.iter_mut().for_each(|link| link.end.forget_answers());
    }

    /// Returns true if a sender may hold a newer message. Asks every sender, even if an earlier one is behind.
    pub(super) fn are_behind(&mut self) -> bool {
        // Asking may read messages that have just arrived.
        self.drained.reset();
        let cx = &mut Context::from_waker(&self.waker);
        self.links.iter_mut().fold(false, |behind, link| link.end.poll_caught_up(cx).is_pending() | behind)
    }

    /// Counts a message that was returned and now waits in the queue.
    pub(super) fn count_waiting(&mut self, link: usize) {
        self.links[link].waiting += 1;
    }

    /// Counts a message that has left the queue.
    pub(super) fn count_gone(&mut self, link: usize) {
        let link = &mut self.links[link];
        link.waiting -= 1;
        if link.waiting == 0 || link.is_awaited {
            // Report now: the program may not receive another message for a long time.
            link.note_waiting(&mut Context::from_waker(&self.waker));
        }
    }

    /// Called when no message waits in the queue any more.
    pub(super) fn count_all_gone(&mut self) {
        self.links.iter_mut().for_each(|link| link.waiting = 0);
        self.note_waiting();
    }

    /// Tells the link that the message returned last was dropped at once.
    pub(super) fn note_dropped(&mut self, link: usize) {
        self.links[link].end.note_dropped();
    }

    /// Tells the links how many messages wait.
    pub(super) fn note_waiting(&mut self) {
        let cx = &mut Context::from_waker(&self.waker);
        self.links.iter_mut().for_each(|link| link.note_waiting(cx));
    }

    pub(super) fn acknowledge_last(&mut self) {
        self.note_waiting();
        self.links.iter_mut().for_each(|link| link.end.acknowledge_last());
    }

    /// Number of messages that wait in the queue.
    pub(super) fn waiting(&self) -> u64 {
        self.links.iter().map(|link| link.waiting).sum()
    }

    /// Number of messages returned.
    pub(super) fn received(&self) -> u64 {
        self.links.iter().map(|link| link.received).sum()
    }

    /// Whether a sender relies on this gate not to drop messages, although its queue would.
    pub(super) fn are_lossless(&self) -> bool {
        self.links.iter().any(|link| link.end.is_lossless())
    }

    /// Number of messages that were not one frame.
    pub(super) fn malformed(&self) -> u64 {
        self.links.iter().map(|link| link.end.malformed()).sum()
    }

    /// Counts a message that was too old when the program was to receive it.
    pub(super) fn count_expired(&mut self, link: usize) {
        self.links[link].expired += 1;
    }

    /// Number of such messages.
    pub(super) fn expired(&self) -> u64 {
        self.links.iter().map(|link| link.expired).sum()
    }

    /// How many messages did not come within the gate's deadline.
    pub(super) fn missed(&self, now: Instant) -> u64 {
        self.links.iter().map(|link| link.missed(now)).sum()
    }

    /// When one more message will be missing, unless one comes before; `None` while nothing is due.
    pub(super) fn next_missed(&self, now: Instant) -> Option<Instant> {
        self.links.iter().filter_map(|link| link.due.as_ref()?.next(now)).min()
    }

    /// Number of connected peers.
    pub(super) fn peers(&self) -> usize {
        self.links.iter().map(|link| link.end.peers()).sum()
    }

    /// The required peers that are not connected, of a gate with one link per peer.
    pub(super) fn missing(&self, spec: &'static GateSpec) -> Vec<Missing> {
        let links = spec.connections.iter().zip(&self.links);
        let missing = links.filter(|(connection, link)| connection.required && link.end.peers() == 0);
        missing.map(|(connection, link)| Missing { connection, refusal: link.end.refusal() }).collect()
    }

    /// Brings the figures of each connection up to date, of a gate with one link per peer.
    pub(super) fn add_to_figures(&self, figures: &mut GateFigures, now: Instant) {
        for (connection, link) in figures.connections.iter_mut().zip(&self.links) {
            (connection.connected, connection.taken) = (link.end.peers() > 0, link.received);
            (connection.missed, connection.expired) = (link.missed(now), link.expired);
        }
    }
}

impl Link {
    fn note_waiting(&mut self, cx: &mut Context<'_>) {
        self.is_awaited = self.end.note_waiting(cx, self.waiting);
    }

    /// Reports a change of the number of peers. Called after every poll, because a waiting call may be woken instead of
    /// the task and complete the connection.
    fn report_peers(&mut self, changes: &Changes) {
        let peers = self.end.peers();
        if std::mem::replace(&mut self.peers, peers) != peers {
            self.is_latched = self.end.is_latched();
            self.note_due();
            changes.report();
        }
    }

    /// Begins to expect messages when the first peer connects, and stops when the last one of those leaves that may be
    /// missing.
    fn note_due(&mut self) {
        match &mut self.due {
            Some(due) if self.peers > 0 => due.begin(Instant::now()),
            Some(due) if self.is_optional => due.end(Instant::now()),
            _ => {}
        }
    }

    fn missed(&self, now: Instant) -> u64 {
        self.due.as_ref().map_or(0, |due| due.missed(now))
    }
}

impl Drop for Links {
    fn drop(&mut self) {
        // Somebody may wait for messages that do not come.
        self.changes.report();
    }
}
