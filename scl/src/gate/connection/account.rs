//! The account of a connection: how many messages there were, and what became of each.

use super::Connection;
use crate::gate::foreign::Counts;
use crate::gate::queue::Queue;
use crate::gate::stats::{Activity, PeerStats};
use crate::runtime_dir::{ConnectionFigures, GateFigures};
use std::task::Context;

/// How many messages there were, and what became of those that left the queue.
#[derive(Debug, Clone, Default)]
pub(super) struct Account {
    /// Messages that the program has sent.
    pub(super) published: u64,
    /// Messages handed to a link, or to plain programs in the place of the component.
    pub(super) handed: u64,
    /// The part of `handed` that went to plain programs, which count it as well.
    pub(super) in_place: u64,
    /// Messages that had not been received by the peer's program when their link broke.
    pub(super) lost: u64,
    /// Messages that were sent once more to a subscriber that has joined.
    pub(super) latched: u64,
    activity: Activity,
}

impl Account {
    pub(super) fn hand(&mut self, length: usize) {
        self.handed += 1;
        self.activity.add(length);
    }
}

impl Connection {
    /// What became of the messages for all peers: the component, and plain ZeroMQ programs.
    fn counts(&self) -> Counts {
        let own = Counts {
            sent: self.account.handed - self.account.in_place,
            replaced: self.queue.replaced,
            dropped_for_observers: 0,
            activity: self.account.activity,
        };
        self.foreign.iter().fold(own.plus(self.foreign_left), |sum, one| sum.plus(one.counts()))
    }

    /// Asks the peer for an acknowledgement: at a slow gate, it sends one only when it is asked.
    pub(crate) fn request_acknowledgement(&mut self) {
        if let Some(link) = &mut self.peer {
            link.request_acknowledgement(&mut Context::from_waker(&self.task));
        }
    }

    /// Adds the counts of this connection to the figures of its gate, and returns the connection's own figures.
    pub(crate) fn add_to_figures(&self, gate: &mut GateFigures) -> ConnectionFigures {
        let Queue { replaced, dropped_oldest, dropped_newest, .. } = self.queue;
        self.check_account();
        let (all, not_received) = (self.counts(), self.not_received());
        let figures = ConnectionFigures {
            connected: self.is_connected(),
            waiting: self.queue.len() as u64,
            taken: self.taken(),
            dropped: dropped_oldest + dropped_newest,
            lost: self.account.lost,
            replaced,
            in_flight: not_received,
            latched: self.account.latched,
            missed: 0,
            expired: 0,
        };
        all.activity.add_to(gate);
        gate.sent += all.sent;
        gate.replaced += all.replaced;
        gate.dropped_oldest += dropped_oldest;
        gate.dropped_newest += dropped_newest;
        gate.dropped_for_observers += all.dropped_for_observers;
        gate.lost += figures.lost;
        gate.waiting += self.queue.len() as u64;
        gate.peers += u64::from(figures.connected);
        figures
    }

    pub(crate) fn stats(&self) -> PeerStats {
        self.check_account();
        let not_received = self.not_received();
        let Queue { replaced, dropped_oldest, dropped_newest, .. } = self.queue;
        PeerStats {
            peer: format!("{}.{}", self.link.peer_component, self.link.peer_gate),
            connected: self.is_connected(),
            published: self.account.published + self.account.latched,
            taken: self.taken(),
            replaced,
            dropped_oldest,
            dropped_newest,
            lost: self.account.lost,
            latched: self.account.latched,
            waiting: self.queue.len() as u64 + not_received,
        }
    }

    /// Checks that published, with those sent once more, = taken + in flight + lost + waiting + replaced + dropped, and
    /// that the peer has received no more than it was sent.
    pub(super) fn check_account(&self) {
        let Account { published, handed, lost, latched, .. } = self.account;
        let Queue { replaced, dropped_oldest, dropped_newest, .. } = self.queue;
        let kept = self.queue.len() as u64 + replaced + dropped_oldest + dropped_newest;
        debug_assert_eq!(published + latched, handed + kept, "the account of {} does not add up", self.peer_name());
        debug_assert!(lost + self.not_received() <= handed, "{} has received more than it was sent", self.peer_name());
    }

    /// Number of messages that the peer's program has received or its queue has dropped, as far as the peer has said.
    fn taken(&self) -> u64 {
        self.account.handed - self.account.lost - self.not_received()
    }

    pub(super) fn unacknowledged(&self) -> u64 {
        self.peer.as_ref().map_or(0, |link| link.unacknowledged())
    }

    pub(super) fn not_received(&self) -> u64 {
        self.peer.as_ref().map_or(0, |link| link.not_received())
    }
}
