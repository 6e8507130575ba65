//! The links of a receiving gate and its queue.

mod shared;

pub(super) use shared::SharedInbox;

use super::catch_up::{Caller, CatchUp};
use super::links::{Arrived, Links};
use super::queue::{Pushed, Queue, QueuePolicy};
use super::ready_set::{ReadySet, ReadySignals};
use super::stats::{Activity, CoarseTime};
use super::tap::{GateTap, ObservedKind};
use super::undecodable::UndecodableCount;
use crate::figures::FiguresInWait;
use crate::runtime_dir::GateFigures;
use crate::spec::{GateSpec, WhenFull};
use crate::state::ReceivingEnd;
use std::collections::VecDeque;
use std::num::NonZero;
use std::sync::{Arc, Weak};
use std::task::{Poll, ready};
use std::time::{Duration, Instant};

/// How many messages one call takes in at most, so that a fast peer cannot keep a call from returning.
const TAKE_IN: usize = 1024;
/// How long a call that does not wait may be held up to fetch what a sender holds back. A publisher without async may
/// need until its next call to answer.
const CATCH_UP: Duration = Duration::from_millis(10);

/// Messages that have arrived at a gate and were not given to the program yet.
pub(super) struct Inbox {
    pub(super) links: Links,
    queue: Queue<Arrived>,
    /// Whether the last receiving call found nothing, and nothing was taken in since.
    was_empty: bool,
    /// Whether the queue was full when the links were drained last, so that messages wake neither call nor task.
    is_stalled: bool,
    /// Time of the last message when the program's progress was last reported to the links of a full queue.
    told_at: Option<CoarseTime>,
    catch_up: CatchUp,
    newest_only: bool,
    /// Whether one link serves all peers.
    listens: bool,
    /// Messages that the codec could not read.
    pub(super) undecodable: UndecodableCount,
    /// Missed messages of which the program was told.
    told_missed: u64,
    activity: Activity,
    in_wait: Arc<FiguresInWait>,
    tap: GateTap,
    ready: ReadySignals,
}

/// The missed messages of which the program was not told yet.
pub(super) enum Untold {
    /// Their number.
    Missed(NonZero<u64>),
    /// There are none before this time; `None` while nothing is due.
    NoneBefore(Option<Instant>),
}

impl Inbox {
    fn new(spec: &GateSpec, links: Links, tap: GateTap) -> Self {
        let policy = QueuePolicy { capacity: spec.options.queue as usize, when_full: spec.options.when_full };
        Self {
            links,
            queue: Queue::new(policy),
            was_empty: false,
            is_stalled: false,
            told_at: None,
            catch_up: CatchUp::default(),
            newest_only: spec.newest_only(),
            listens: !spec.endpoint.is_empty(),
            undecodable: UndecodableCount::of_links(spec.connections.len()),
            told_missed: 0,
            in_wait: Arc::new(FiguresInWait::new(spec.connections.len())),
            activity: Activity::default(),
            tap,
            ready: ReadySignals::default(),
        }
    }

    /// Takes in what has arrived while the program is busy elsewhere. Returns true if a message waits.
    fn drive(&mut self) -> bool {
        self.take_in();
        self.report_ready();
        !self.queue.is_empty() || self.catch_up.is_waiting()
    }

    fn poll_next(&mut self, caller: Caller) -> Poll<Arrived> {
        // After a pending call the queue was empty, so the first arrival cannot overflow it.
        if self.was_empty && !self.newest_only {
            let polled = self.poll_links();
            self.was_empty = polled.is_pending();
            if polled.is_ready() {
                // Drain the links: a link that is ready has not registered the waker, so the next event would wake
                // nothing.
                self.take_in();
            }
            return polled;
        }
        if self.newest_only {
            // A sender's answer counts only if its link was polled just now.
            self.links.look_again();
        }
        self.take_in();
        if self.newest_only {
            ready!(self.catch_up.poll(&mut self.links, caller));
            self.take_in();
        }
        let first = self.pop();
        self.was_empty = first.is_none();
        first.map_or(Poll::Pending, Poll::Ready)
    }

    /// Waits for the next message on the calling thread, without a runtime, at most `within`. Only a gate with one link
    /// can wait this way, because it waits for one socket.
    pub(super) fn wait(&mut self, within: Duration) -> Option<Arrived> {
        let arrived = self.wait_on_link(within);
        self.report_ready();
        arrived
    }

    fn wait_on_link(&mut self, within: Duration) -> Option<Arrived> {
        let started = Instant::now();
        let mut caller = Caller::NewCall;
        loop {
            if let Poll::Ready(arrived) = self.poll_next(caller) {
                return Some(arrived);
            }
            caller = Caller::SameCall;
            if self.links.len() != 1 {
                return None;
            }
            let within = within.checked_sub(started.elapsed())?;
            let in_wait = Arc::clone(&self.in_wait);
            let waiting = in_wait.begin(|figures| self.read_figures(figures));
            let arrived = self.links.wait(within);
            drop(waiting);
            if !arrived {
                return None;
            }
        }
    }

    /// Returns the next message if one has arrived.
    pub(super) fn try_next(&mut self) -> Option<Arrived> {
        self.was_empty = false;
        if self.queue.is_empty() || self.newest_only {
            self.fetch();
            self.take_in();
        }
        let next = self.pop();
        self.report_ready();
        next
    }

    /// Moves what has arrived into `arrived`, which must be empty, so that its caller can choose the newest.
    pub(super) fn take_all(&mut self, arrived: &mut VecDeque<Arrived>) {
        self.was_empty = false;
        self.fetch();
        self.take_in();
        if !self.queue.waits() && self.links.are_lossless() {
            // The sender relies on this gate not to drop messages, so return them one at a time.
            arrived.extend(self.pop());
            return self.report_ready();
        }
        std::mem::swap(self.queue.items_mut(), arrived);
        self.links.count_all_gone();
        if self.queue.waits() {
            // Such a gate reads no more than its queue holds, but messages that the caller skips must not keep a
            // publisher waiting, so read on.
            self.links.look_again();
            self.pass_over(arrived);
            self.links.note_waiting();
        }
        self.report_ready();
    }

    fn pass_over(&mut self, arrived: &mut VecDeque<Arrived>) {
        for _ in 0..TAKE_IN {
            let Poll::Ready(newer) = self.poll_links() else { return };
            if arrived.len() >= self.queue.policy.capacity {
                arrived.pop_front();
            }
            arrived.push_back(newer);
        }
        // More may be left: poll again later, as in `drain_links`.
        self.links.ask_later();
    }

    /// Reports to `set`, from now on, whether a message can be received.
    pub(super) fn report_to(&mut self, set: Weak<ReadySet>) {
        self.ready.add(set);
        self.report_ready();
    }

    /// Stops reporting: the gate is dropped, so nothing can be received any more.
    pub(super) fn stop_reporting(&mut self) {
        self.ready = ReadySignals::default();
    }

    /// Reports whether a message can be received; called whenever messages were added or removed. Only messages in the
    /// queue count, so an empty queue is filled first: if it stays empty, the links have nothing, and wake the task as
    /// soon as they do.
    fn report_ready(&mut self) {
        if self.ready.is_empty() {
            return;
        }
        if self.queue.is_empty() {
            self.take_in();
        }
        self.ready.report(!self.queue.is_empty());
    }

    /// Drains the links into the queue, only up to its capacity if its senders rely on that, and tells them what the
    /// program has received.
    fn take_in(&mut self) {
        if !self.links.may_have_more() {
            return;
        }
        // Report before draining, too: the links may then read a request for this number.
        self.links.note_waiting();
        self.drain_links();
        self.links.note_waiting();
        debug_assert_eq!(
            self.links.waiting(),
            self.queue.len() as u64,
            "each message in the queue is counted for its sender"
        );
    }

    fn drain_links(&mut self) {
        for _ in 0..TAKE_IN {
            self.is_stalled = self.queue.is_full() && (self.queue.waits() || self.links.are_lossless());
            if self.is_stalled {
                return self.links.connect();
            }
            if !self.take_in_one() {
                return;
            }
        }
        // More may be left: the task continues after other tasks have run.
        self.links.ask_later();
    }

    /// Takes in a message in place of one that has left a full queue. The links are connected already.
    fn take_in_for_room(&mut self) {
        // Report once per tick of the coarse clock: reporting every message would slow down a fast program.
        let last = self.activity.last;
        if std::mem::replace(&mut self.told_at, last) != last {
            self.links.note_waiting();
        }
        self.links.look_again();
        self.is_stalled = self.take_in_one();
        if self.is_stalled {
            self.links.rest();
        }
    }

    /// Takes in one message. Returns false if nothing has arrived; the links then wake the task as soon as something
    /// does.
    fn take_in_one(&mut self) -> bool {
        let Poll::Ready(arrived) = self.poll_links() else { return false };
        self.was_empty = false;
        self.keep(arrived);
        true
    }

    fn poll_links(&mut self) -> Poll<Arrived> {
        let arrived = ready!(self.links.poll_next());
        self.activity.add(arrived.frame.len());
        self.tap.observe(ObservedKind::Message, 0, &arrived.frame);
        Poll::Ready(arrived)
    }

    fn keep(&mut self, arrived: Arrived) {
        let link = arrived.link;
        let gone = if !self.queue.is_full() {
            self.queue.push(arrived);
            None
        } else if arrived.is_latched && self.queue.policy.when_full == WhenFull::DropNewest {
            // A latched message is the current state, so it must not be dropped in favour of older messages.
            self.queue.push_over_newest(arrived).map(|newest| newest.link)
        } else {
            let oldest = self.queue.front().map(|oldest| oldest.link);
            if self.queue.push(arrived) == Pushed::Dropped {
                return self.links.note_dropped(link);
            }
            oldest
        };
        self.links.count_waiting(link);
        if let Some(gone) = gone {
            self.links.count_gone(gone);
        }
    }

    fn pop(&mut self) -> Option<Arrived> {
        let arrived = self.queue.pop()?;
        self.links.count_gone(arrived.link);
        if self.is_stalled {
            // Read on now: a sender that is closing asks what was received, and waits for the answer.
            self.take_in_for_room();
        }
        Some(arrived)
    }

    /// Tells the program of messages that did not come within the gate's deadline, each once.
    pub(super) fn tell_missed(&mut self) -> Untold {
        let now = Instant::now();
        let missed = self.links.missed(now);
        debug_assert!(missed >= self.told_missed, "counts only rise");
        match NonZero::new(missed.saturating_sub(self.told_missed)) {
            Some(untold) => {
                self.told_missed = missed;
                Untold::Missed(untold)
            }
            None => Untold::NoneBefore(self.links.next_missed(now)),
        }
    }

    fn fetch(&mut self) {
        self.links.fetch(if self.newest_only { CATCH_UP } else { Duration::ZERO });
    }

    /// Brings the figures of the gate up to date.
    pub(super) fn read_figures(&self, figures: &mut GateFigures) {
        let (undecodable, tap_dropped, now) = (self.undecodable.total(), self.tap.dropped(), Instant::now());
        figures.set(GateFigures {
            received: self.links.received(),
            rejected: undecodable + self.links.malformed(),
            undecodable,
            missed: self.links.missed(now),
            expired: self.links.expired(),
            replaced: self.queue.replaced,
            dropped_oldest: self.queue.dropped_oldest,
            dropped_newest: self.queue.dropped_newest,
            dropped_for_observers: tap_dropped,
            tap_dropped,
            waiting: self.queue.len() as u64,
            peers: self.links.peers() as u64,
            ..GateFigures::default()
        });
        self.activity.add_to(figures);
        if self.listens {
            return figures.share();
        }
        self.links.add_to_figures(figures, now);
    }
}

impl ReceivingEnd for Inbox {
    fn acknowledge_last(&mut self) {
        self.links.acknowledge_last();
    }
}

impl Drop for Inbox {
    fn drop(&mut self) {
        self.acknowledge_last();
    }
}
