//! The end of a `rep` gate, shared by its calls, its requests and its background task.

use super::io_waker::{Drained, IoWaker};
use super::ready_set::{ReadySet, ReadySignals};
use super::stats::{Activity, GateStats};
use super::tap::GateTap;
use crate::error::Unflushed;
use crate::figures::FigureSource;
use crate::runtime_dir::GateFigures;
use crate::state::{ComponentState, SendingEnd, WakeCall};
use crate::sync::{AbortOnDrop, lock, try_lock};
use crate::transport::{IncomingRequest, Replier};
use std::sync::{Arc, Mutex, Weak};
use std::task::{Context, Poll, Waker, ready};
use tokio::runtime::Handle;

/// Up to this number of requesters, a call that takes a request polls the connections itself, which is cheaper than
/// waking the task.
const DRIVEN_BY_CALLS: usize = 64;

/// A request and its number at this gate, counted from 1.
pub(super) type Numbered = (u64, IncomingRequest);

pub(super) struct ReplyEnd {
    link: Arc<Mutex<Link>>,
    pub(super) io: Arc<IoWaker>,
    _task: AbortOnDrop,
}

struct Link {
    replier: Box<dyn Replier>,
    drained: Drained,
    waker: Waker,
    written: bool,
    peers: usize,
    received: u64,
    undecodable: u64,
    activity: Activity,
    /// A request that was read ahead to find out whether there is one.
    next: Option<IncomingRequest>,
    ready: ReadySignals,
    /// The wakers of waiting flushes: a dropped gate and the component may both be flushing.
    waiting_flushes: Vec<Waker>,
}

impl ReplyEnd {
    /// Opens the end and starts the task that drives it. Must be called inside a tokio runtime.
    pub(super) fn open(replier: Box<dyn Replier>, state: &Arc<ComponentState>) -> Arc<Self> {
        let io = Arc::new(IoWaker::default());
        state.register_calls(Arc::downgrade(&io) as _);
        let waker = Waker::from(Arc::clone(&io));
        let link = Arc::new(Mutex::new(Link {
            replier,
            drained: Drained::new(Arc::clone(&io)),
            waker,
            written: true,
            peers: 0,
            received: 0,
            undecodable: 0,
            activity: Activity::default(),
            next: None,
            ready: ReadySignals::default(),
            waiting_flushes: Vec::new(),
        }));
        state.register(Arc::clone(&link) as _);
        let (task_io, changes) = (Arc::clone(&io), state.changes());
        let task = AbortOnDrop::drive(&Handle::current(), &link, move |link, cx| {
            task_io.set_task(cx.waker());
            if lock(link).drive_by_task() {
                changes.report();
            }
            task_io.wake_call();
        });
        Arc::new(Self { link, io, _task: task })
    }

    /// Returns the next request with its number, or registers the call and returns `Pending`. `may_vanish`: see
    /// [`IoWaker::wait`].
    pub(super) fn poll_next(&self, cx: &mut Context<'_>, may_vanish: bool) -> Poll<Numbered> {
        let mut link = lock(&self.link);
        let polled = link.poll_next();
        link.report_ready();
        if polled.is_pending() {
            self.io.wait(cx.waker(), may_vanish);
        }
        polled
    }

    /// Ready when a request is waiting; otherwise registers the call, which may vanish: see [`IoWaker::wait`].
    pub(super) fn poll_ready(&self, cx: &mut Context<'_>) -> Poll<()> {
        let mut link = lock(&self.link);
        let found = link.look_ahead();
        link.report_ready();
        if found {
            return Poll::Ready(());
        }
        self.io.wait(cx.waker(), true);
        Poll::Pending
    }

    pub(super) fn try_next(&self) -> Option<Numbered> {
        let mut link = lock(&self.link);
        let polled = link.poll_next();
        link.report_ready();
        match polled {
            Poll::Ready(request) => Some(request),
            Poll::Pending => None,
        }
    }

    /// Returns a function that makes the end report to a set whether it has a request. It does not keep the end open.
    pub(super) fn reporter(&self) -> impl Fn(Weak<ReadySet>) + Send + Sync + 'static {
        let link = Arc::downgrade(&self.link);
        move |set| {
            if let Some(link) = link.upgrade() {
                let mut link = lock(&link);
                link.ready.add(set);
                link.report_ready();
            }
        }
    }

    /// Stops reporting to sets: the gate was dropped, so no request can be taken any more, but the end may still have
    /// replies to write.
    pub(super) fn stop_reporting(&self) {
        lock(&self.link).ready = ReadySignals::default();
    }

    pub(super) fn peers(&self) -> usize {
        lock(&self.link).replier.peers()
    }

    pub(super) fn stats(&self) -> GateStats {
        GateStats { waiting: 0, ..GateStats::of(|figures| lock(&self.link).read_figures(figures)) }
    }

    /// Counts an undecodable request. Returns true for the first one.
    pub(super) fn count_undecodable(&self) -> bool {
        let mut link = lock(&self.link);
        link.undecodable += 1;
        link.undecodable == 1
    }

    pub(super) fn figures(self: &Arc<Self>, tap: &GateTap) -> FigureSource {
        // The link may live longer than its gate, until the last reply is written.
        let (end, dropped) = (Arc::downgrade(self), tap.dropped_later());
        Box::new(move |figures| {
            let Some(end) = end.upgrade() else { return false };
            if let Some(link) = try_lock(&end.link) {
                link.read_figures(figures);
                figures.tap_dropped = dropped();
                figures.dropped_for_observers = figures.tap_dropped;
            }
            true
        })
    }

    /// Returns the link, which the component keeps until the last reply is written.
    pub(super) fn link(&self) -> Arc<Mutex<dyn SendingEnd>> {
        Arc::clone(&self.link) as _
    }
}

impl Link {
    fn poll_next(&mut self) -> Poll<Numbered> {
        let request = match self.next.take() {
            Some(request) => request,
            None => ready!(self.poll_request()),
        };
        self.received += 1;
        self.activity.add(request.body.len());
        self.keep_alive();
        Poll::Ready((self.received, request))
    }

    fn poll_request(&mut self) -> Poll<IncomingRequest> {
        if self.drained.still_holds() {
            return Poll::Pending;
        }
        let polled = self.replier.poll_request(&mut Context::from_waker(&self.waker));
        if polled.is_pending() {
            self.drained.set();
        }
        polled
    }

    /// Polls all connections, or wakes the task to do so, because the program may take long to handle the request. The
    /// event that woke its call causes no other wake-up before they are polled, so heartbeats would remain unanswered
    /// in the meantime.
    fn keep_alive(&mut self) {
        if self.replier.peers() > DRIVEN_BY_CALLS {
            self.waker.wake_by_ref();
        } else if self.look_ahead() {
            // `look_ahead` stops at the first request, so it may not have polled all connections.
            let waker = self.waker.clone();
            self.drive(&mut Context::from_waker(&waker));
        }
    }

    /// Updates the figures, except those of the tap.
    fn read_figures(&self, figures: &mut GateFigures) {
        figures.set(GateFigures {
            received: self.received,
            rejected: self.undecodable + self.replier.malformed(),
            undecodable: self.undecodable,
            waiting: self.next.is_some().into(),
            peers: self.replier.peers() as u64,
            ..GateFigures::default()
        });
        figures.share();
        self.activity.add_to(figures);
    }

    /// Reads a request ahead, unless one was read already. Returns true if there is one.
    fn look_ahead(&mut self) -> bool {
        if self.next.is_none()
            && let Poll::Ready(request) = self.poll_request()
        {
            self.next = Some(request);
        }
        self.next.is_some()
    }

    /// Reports to the sets whether there is a request. Called whenever one may have arrived or was taken.
    fn report_ready(&mut self) {
        if !self.ready.is_empty() {
            let found = self.look_ahead();
            self.ready.report(found);
        }
    }

    /// Drives the end from its task. Returns true if the number of requesters has changed.
    fn drive_by_task(&mut self) -> bool {
        let waker = self.waker.clone();
        self.drive(&mut Context::from_waker(&waker));
        self.report_ready();
        let peers = self.replier.peers();
        std::mem::replace(&mut self.peers, peers) != peers
    }
}

impl SendingEnd for Link {
    fn poll_flushed(&mut self, _acknowledged: bool, cx: &mut Context<'_>) -> Poll<()> {
        let waker = self.waker.clone();
        self.drained.reset();
        self.written = self.replier.drive(&mut Context::from_waker(&waker));
        if self.written {
            return Poll::Ready(());
        }
        if !self.waiting_flushes.iter().any(|known| known.will_wake(cx.waker())) {
            self.waiting_flushes.push(cx.waker().clone());
        }
        Poll::Pending
    }

    fn waits_for_absent_peer(&self) -> Option<Unflushed> {
        None
    }

    /// Returns `None`: it is not known here which requester did not read its reply. That requester's call times out.
    fn leftover(&self, _acknowledged: bool) -> Option<Unflushed> {
        None
    }

    fn drive(&mut self, cx: &mut Context<'_>) {
        self.drained.reset();
        self.written = self.replier.drive(cx);
        if self.written {
            self.waiting_flushes.drain(..).for_each(Waker::wake);
        }
    }

    /// Replies are never held back.
    fn write_out(&mut self) -> bool {
        true
    }

    fn detach(&mut self) {
        self.replier.detach();
    }
}
