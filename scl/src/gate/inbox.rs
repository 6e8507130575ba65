//! The ends of a receiving gate and its queue, shared by the calls of the program and the gate's background task.

use super::catch_up::{Caller, CatchUp};
use super::io_waker::IoWaker;
use super::queue::{Pushed, Queue, QueuePolicy};
use super::ready_set::{ReadySet, ReadySignals};
use super::stats::Activity;
use super::tap::{GateTap, Observed};
use super::undecodable::UndecodableCount;
use crate::error::Missing;
use crate::figures::{FigureSource, FiguresInWait};
use crate::runtime_dir::GateFigures;
use crate::spec::{GateSpec, WhenFull};
use crate::state::{Changes, ComponentState, ReceivingEnd, WakeCall};
use crate::sync::{AbortOnDrop, lock, try_lock};
use crate::transport::Receiver;
use bytes::Bytes;
use scl_fork::ProcessOwned;
use std::collections::VecDeque;
use std::future::poll_fn;
use std::sync::{Arc, Mutex, Weak};
use std::task::{Context, Poll, Waker, ready};
use std::time::{Duration, Instant};

/// How many messages one call takes in at most, so that a fast peer cannot keep a call from returning.
const TAKE_IN: usize = 1024;
/// How long a call that does not wait may be held up to fetch what a sender holds back. A publisher without async may need
/// until its next call to answer.
const CATCH_UP: Duration = Duration::from_millis(10);

/// What has arrived at a gate and was not given to the program yet.
pub(super) struct Inbox {
    links: Vec<Box<dyn Receiver>>,
    /// The link to ask first, so that all get their turn.
    next: usize,
    queue: Queue<Arrived>,
    /// Whether the last receiving call found nothing, and nothing was taken in since.
    was_empty: bool,
    /// Whether the queue was full when the links were drained last, so that they will not wake anybody.
    is_stalled: bool,
    catch_up: CatchUp,
    newest_only: bool,
    /// Whether one link serves all peers.
    listens: bool,
    pub(super) received: u64,
    /// The same for each link.
    received_over: Vec<u64>,
    /// Whether the sender of each link keeps its last message for those that join.
    latched: Vec<bool>,
    /// How many messages of each link wait in the queue.
    waiting_of: Vec<u64>,
    /// Messages that the codec could not read.
    pub(super) undecodable: UndecodableCount,
    pub(super) activity: Activity,
    in_wait: Arc<FiguresInWait>,
    tap: GateTap,
    waker: Waker,
    connected: Vec<usize>,
    changes: Changes,
    ready: ReadySignals,
}

/// A message and the link that it came from.
pub(super) struct Arrived {
    pub(super) link: usize,
    pub(super) frame: Bytes,
    /// When it was sent, if that was before this gate had joined.
    pub(super) latched: Option<Instant>,
}

/// The inbox, its waker, and the task that drives it.
pub(super) struct SharedInbox {
    inbox: ProcessOwned<Arc<Mutex<Inbox>>>,
    pub(super) io: Arc<IoWaker>,
    _task: AbortOnDrop,
}

impl SharedInbox {
    /// Starts to receive. Needs a tokio runtime.
    pub(super) fn new(spec: &GateSpec, links: Vec<Box<dyn Receiver>>, tap: GateTap, state: &ComponentState) -> Self {
        let io = Arc::new(IoWaker::default());
        state.register_calls(Arc::downgrade(&io) as _);
        let waker = Waker::from(Arc::clone(&io));
        let inbox = Arc::new(Mutex::new(Inbox::new(spec, links, tap, state.changes(), waker)));
        state.register_receiving(Arc::downgrade(&inbox) as _);
        // Weak, so that the ends are gone with the gate, and not only when the runtime drops the task.
        let (driven, task_io) = (Arc::downgrade(&inbox), Arc::clone(&io));
        let task = tokio::spawn(poll_fn(move |cx| {
            task_io.set_task(cx.waker());
            let Some(inbox) = driven.upgrade() else { return Poll::Ready(()) };
            if lock(&inbox).drive() {
                task_io.wake_call();
            }
            Poll::Pending
        }));
        Self { inbox: ProcessOwned::new(inbox), io, _task: AbortOnDrop::new(task.abort_handle()) }
    }

    /// Returns the next message, or registers the call and returns `Pending`.
    pub(super) fn poll_next(&self, cx: &mut Context<'_>, caller: Caller) -> Poll<Arrived> {
        let mut inbox = lock(&self.inbox);
        let polled = inbox.poll_next(caller);
        inbox.report_ready();
        if polled.is_pending() {
            self.io.wait(cx.waker(), caller == Caller::Stream);
        }
        polled
    }

    /// Ready when a message waits; otherwise registers the call, which may vanish.
    pub(super) fn poll_ready(&self, cx: &mut Context<'_>) -> Poll<()> {
        let mut inbox = lock(&self.inbox);
        inbox.take_in();
        inbox.report_ready();
        if inbox.queue.is_empty() {
            self.io.wait(cx.waker(), true);
            return Poll::Pending;
        }
        Poll::Ready(())
    }

    pub(super) fn lock(&self) -> std::sync::MutexGuard<'_, Inbox> {
        lock(&self.inbox)
    }

    pub(super) fn figures(&self) -> FigureSource {
        let (inbox, in_wait) = (self.downgrade(), Arc::clone(&self.lock().in_wait));
        Box::new(move |figures| {
            let Some(inbox) = inbox.upgrade() else { return false };
            match try_lock(&inbox) {
                Some(inbox) => inbox.read_figures(figures),
                None => in_wait.copy_to(figures),
            }
            true
        })
    }

    pub(super) fn downgrade(&self) -> Weak<Mutex<Inbox>> {
        Arc::downgrade(&self.inbox)
    }
}

impl Inbox {
    fn new(spec: &GateSpec, links: Vec<Box<dyn Receiver>>, tap: GateTap, changes: Changes, waker: Waker) -> Self {
        let policy = QueuePolicy { capacity: spec.options.queue as usize, when_full: spec.options.when_full };
        Self {
            connected: vec![0; links.len()],
            received_over: vec![0; links.len()],
            latched: vec![false; links.len()],
            waiting_of: vec![0; links.len()],
            links,
            next: 0,
            queue: Queue::new(policy),
            was_empty: false,
            is_stalled: false,
            catch_up: CatchUp::default(),
            newest_only: spec.newest_only(),
            listens: !spec.endpoint.is_empty(),
            received: 0,
            undecodable: UndecodableCount::of_links(spec.connections.len()),
            in_wait: Arc::new(FiguresInWait::new(spec.connections.len())),
            activity: Activity::default(),
            tap,
            waker,
            changes,
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
                // Polled until nothing is left, or the next event would find nobody to wake.
                self.take_in();
            }
            return polled;
        }
        self.take_in();
        if self.newest_only {
            let cx = &mut Context::from_waker(&self.waker);
            ready!(self.catch_up.poll(cx, &mut self.links, caller));
            self.take_in();
        }
        let first = self.pop();
        self.was_empty = first.is_none();
        first.map_or(Poll::Pending, Poll::Ready)
    }

    /// Waits for the next message on the calling thread, without a runtime, for a short time. Only a gate with one peer
    /// can: it waits for one socket.
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
            let arrived = self.links[0].wait(within);
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
        if !self.queue.waits() && self.is_lossless() {
            // The sender waits for each of its messages: at any time there is only one.
            arrived.extend(self.pop());
            return self.report_ready();
        }
        std::mem::swap(self.queue.items_mut(), arrived);
        self.waiting_of.fill(0);
        self.note_waiting();
        if self.queue.waits() {
            // Such a gate takes in no more than its queue holds, but what is passed over keeps no publisher waiting.
            self.pass_over(arrived);
            self.note_waiting();
        }
        self.report_ready();
    }

    fn pass_over(&mut self, arrived: &mut VecDeque<Arrived>) {
        for _ in 0..TAKE_IN {
            let Poll::Ready(newer) = self.poll_links() else { return };
            if arrived.len() >= self.queue.policy().capacity {
                arrived.pop_front();
            }
            arrived.push_back(newer);
        }
        // There is more, as in `drain_links`.
        self.waker.wake_by_ref();
    }

    /// From now on reports to a set whether something can be received.
    pub(super) fn report_to(&mut self, set: Weak<ReadySet>) {
        self.ready.add(set);
        self.report_ready();
    }

    /// The gate is gone, so nothing can be received any more.
    pub(super) fn stop_reporting(&mut self) {
        self.ready = ReadySignals::default();
    }

    /// Called whenever messages were added or removed. Only what is in the queue counts, so it is filled first: then the
    /// links have nothing, and wake the task as soon as they do.
    fn report_ready(&mut self) {
        if self.ready.is_empty() {
            return;
        }
        if self.queue.is_empty() {
            self.take_in();
        }
        self.ready.report(!self.queue.is_empty());
    }

    /// Drains the links into the queue, as far as it makes its senders wait, and notes what the program has received.
    fn take_in(&mut self) {
        self.drain_links();
        self.note_waiting();
    }

    fn drain_links(&mut self) {
        for _ in 0..TAKE_IN {
            self.is_stalled = self.queue.is_full() && (self.queue.waits() || self.is_lossless());
            if self.is_stalled {
                return self.connect_links();
            }
            if !self.take_in_one() {
                return;
            }
        }
        // There is more: the task continues after others had their turn.
        self.waker.wake_by_ref();
    }

    fn keep(&mut self, arrived: Arrived) {
        if arrived.latched.is_some() && self.queue.policy().when_full == WhenFull::DropNewest {
            // It is the state that holds; those before it are not.
            self.waiting_of[arrived.link] += 1;
            if let Some(newest) = self.queue.push_over_newest(arrived) {
                self.waiting_of[newest.link] -= 1;
            }
            return;
        }
        let (link, oldest) = (arrived.link, self.queue.front().map(|oldest| oldest.link));
        match (self.queue.push(arrived), oldest) {
            (Pushed::Dropped, _) => return self.links[link].note_dropped(),
            (Pushed::ReplacedOldest, Some(oldest)) => self.waiting_of[oldest] -= 1,
            _ => {}
        }
        self.waiting_of[link] += 1;
    }

    fn pop(&mut self) -> Option<Arrived> {
        let arrived = self.queue.pop()?;
        let (link, waiting) = (arrived.link, &mut self.waiting_of[arrived.link]);
        *waiting -= 1;
        if *waiting == 0 {
            // The program may receive nothing for long, and its sender may wait for this.
            self.links[link].note_waiting(0);
        }
        if self.is_stalled {
            // For the same reason: a sender that closes asks what was received, and waits for the answer. There is room
            // for one message now, and the links are connected already.
            self.is_stalled = self.take_in_one();
        }
        Some(arrived)
    }

    /// Returns false if nothing has arrived; the links then wake the task as soon as something does.
    fn take_in_one(&mut self) -> bool {
        let Poll::Ready(arrived) = self.poll_links() else { return false };
        self.was_empty = false;
        self.keep(arrived);
        true
    }

    fn note_waiting(&mut self) {
        for (link, waiting) in self.links.iter_mut().zip(&self.waiting_of) {
            link.note_waiting(*waiting);
        }
    }

    /// Without this, a component that takes nothing before all of its peers are there would wait forever, once the first
    /// of them has filled the queue.
    fn connect_links(&mut self) {
        let cx = &mut Context::from_waker(&self.waker);
        for ((link, connected), latched) in self.links.iter_mut().zip(&mut self.connected).zip(&mut self.latched) {
            link.connect(cx);
            if report_peers(&**link, connected, &self.changes) {
                *latched = link.is_latched();
            }
        }
    }

    /// Whether a sender relies on this gate not to drop messages, although its queue would.
    fn is_lossless(&self) -> bool {
        self.links.iter().any(|link| link.is_lossless())
    }

    fn poll_links(&mut self) -> Poll<Arrived> {
        let cx = &mut Context::from_waker(&self.waker);
        let count = self.links.len();
        for offset in 0..count {
            let link = (self.next + offset) % count;
            let polled = self.links[link].poll_recv(cx);
            if report_peers(&*self.links[link], &mut self.connected[link], &self.changes) {
                self.latched[link] = self.links[link].is_latched();
            }
            if let Poll::Ready(frame) = polled {
                self.next = (link + 1) % count;
                self.received += 1;
                self.received_over[link] += 1;
                self.activity.add(frame.len());
                self.tap.observe(Observed::Message, 0, &frame);
                let latched = if self.latched[link] { self.links[link].take_latched() } else { None };
                return Poll::Ready(Arrived { link, frame, latched });
            }
        }
        Poll::Pending
    }

    /// Asks the operating system, because the runtime may not have had a turn for long.
    fn fetch(&mut self) {
        let within = if self.newest_only { CATCH_UP } else { Duration::ZERO };
        self.links.iter_mut().for_each(|link| link.catch_up(within));
    }

    /// The required peers that are not connected, of a gate with one link per peer.
    pub(super) fn missing(&self, spec: &'static GateSpec) -> Vec<Missing> {
        let links = spec.connections.iter().zip(&self.links);
        let missing = links.filter(|(link, end)| link.required && end.peers() == 0);
        missing.map(|(connection, end)| Missing { connection, refusal: end.refusal() }).collect()
    }

    /// Brings the figures of the gate up to date.
    pub(super) fn read_figures(&self, figures: &mut GateFigures) {
        figures.clear();
        figures.received = self.received;
        figures.rejected = self.rejected();
        figures.undecodable = self.undecodable.total();
        figures.replaced = self.queue.replaced;
        figures.dropped_oldest = self.queue.dropped_oldest;
        figures.dropped_newest = self.queue.dropped_newest;
        figures.tap_dropped = self.tap_dropped();
        figures.dropped_for_observers = figures.tap_dropped;
        figures.waiting = self.queue.len() as u64;
        figures.peers = self.peers() as u64;
        self.activity.add_to_figures(figures);
        if self.listens {
            return figures.share(self.peers() as u64, self.received);
        }
        let links = self.links.iter().zip(&self.received_over);
        for (connection, (link, received)) in figures.connections.iter_mut().zip(links) {
            (connection.connected, connection.taken) = (link.peers() > 0, *received);
        }
    }

    /// Number of messages that could not be used.
    pub(super) fn rejected(&self) -> u64 {
        self.undecodable.total() + self.malformed()
    }

    pub(super) fn queue(&self) -> &Queue<Arrived> {
        &self.queue
    }

    pub(super) fn tap_dropped(&self) -> u64 {
        self.tap.dropped()
    }

    /// Number of messages that were not one frame.
    fn malformed(&self) -> u64 {
        self.links.iter().map(|link| link.malformed()).sum()
    }

    /// Number of connected peers.
    pub(super) fn peers(&self) -> usize {
        self.links.iter().map(|link| link.peers()).sum()
    }
}

impl ReceivingEnd for Inbox {
    fn acknowledge_last(&mut self) {
        self.note_waiting();
        self.links.iter_mut().for_each(|link| link.acknowledge_last());
    }
}

impl Drop for Inbox {
    fn drop(&mut self) {
        self.acknowledge_last();
    }
}

/// Called after every poll of a link: a waiting call is woken instead of the task, and completes the connection.
/// Returns true if their number has changed.
fn report_peers(link: &dyn Receiver, connected: &mut usize, changes: &Changes) -> bool {
    let peers = link.peers();
    let has_changed = std::mem::replace(connected, peers) != peers;
    if has_changed {
        changes.report();
    }
    has_changed
}
