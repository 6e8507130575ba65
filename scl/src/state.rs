//! What all gates of a component share: its registration, its runtime if it was opened without async, and the ends that
//! may still have something to send.

mod calls;
mod flush;
mod monitor;
mod owner;
mod parameters;
mod reported;
mod runtime;
#[cfg(test)]
mod tests;

pub(crate) use calls::WakeCall;
pub(crate) use flush::{Flush, LINGER, ReceivingEnd, SendingEnd};
pub(crate) use monitor::stats_period;
pub(crate) use owner::Owner;
pub use runtime::prepare_thread;
pub(crate) use runtime::{Driven, OwnedRuntime};

use monitor::Monitor;

use crate::error::{BlockingError, Missing, NotFlushed, PeerName, Unflushed};
use crate::log;
use crate::registration::StatsWriter;
use crate::registry::{Neighbour, Registered as RegisteredComponent};
use crate::runtime_dir::ComponentStats;
use crate::service::{self, Member};
use crate::spec::{ComponentSpec, GateSpec};
use crate::sync::{AbortOnDrop, await_other_users, lock, on_another_thread, on_living_thread};
use crate::values::Values;
use scl_fork::ProcessMark;
#[cfg(feature = "protobuf")]
use scl_shape::FileDescriptorSet;
use std::future::poll_fn;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, Weak};
use std::task::{Context, Poll, Waker};
use std::time::{Duration, Instant};
use tokio::runtime::Handle;
use tokio::sync::Notify;
use tokio::sync::futures::Notified;

/// The part of a component that lives as long as any of its gates.
pub(crate) struct ComponentState {
    pub(crate) spec: &'static ComponentSpec,
    process: ProcessMark,
    changes: Changes,
    ends: Mutex<Vec<Registered>>,
    receiving: Mutex<Vec<Weak<Mutex<dyn ReceivingEnd>>>>,
    /// Messages of dropped gates that their peers did not take in time.
    given_up: Mutex<Vec<Unflushed>>,
    flushed: Mutex<bool>,
    runtime: Option<Arc<OwnedRuntime>>,
    /// The runtime on which the ends do I/O.
    handle: Handle,
    /// Whether that runtime has ended. Its timers and sockets must not be polled any more then.
    runtime_ended: Arc<AtomicBool>,
    /// Whether all calls of the gates have been ended for good.
    calls_ended: AtomicBool,
    /// Whether the component is one of the two in a unit test.
    pub(crate) is_test: bool,
    /// The message types of `schemas:`, decoded when the first gate needs them.
    #[cfg(feature = "protobuf")]
    message_types: OnceLock<Option<FileDescriptorSet>>,
    /// Wakes the waiting calls that no sending end wakes.
    waiting_calls: Mutex<Vec<Weak<dyn WakeCall>>>,
    pub(crate) monitor: Arc<Monitor>,
    /// The values of its parameters.
    pub(crate) parameters: Values,
    /// What listens for new values of live parameters, if it has any.
    setter: OnceLock<Box<dyn Send + Sync>>,
    /// Writes the component's stats, if it has any.
    _stats: Option<AbortOnDrop>,
    /// The component as reported to the service manager, if there is one.
    member: Option<Arc<Member>>,
    /// The task that reports the component to the service manager.
    reporting: OnceLock<AbortOnDrop>,
    /// Number of [`Owner`]s.
    owners: AtomicUsize,
    /// Keeps the registration if the runtime folder is removed.
    _keeper: AbortOnDrop,
    /// Dropped last: once the lock is released, another process may run this component.
    pub(crate) registration: Box<dyn RegisteredComponent>,
}

/// A sending end and the task that drives it.
struct Registered {
    end: Arc<Mutex<dyn SendingEnd>>,
    _task: Option<AbortOnDrop>,
}

/// The part of a component that generated code holds besides the gates.
#[derive(Debug, Clone)]
pub struct ComponentHandle(pub(crate) Owner);

struct SetOnDrop(Arc<AtomicBool>);

impl Drop for SetOnDrop {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

/// Reports that something has changed that calls wait for: a peer, a parameter, or that the component is closed.
#[derive(Clone, Default)]
pub(crate) struct Changes(Arc<Notify>);

impl Changes {
    pub(crate) fn report(&self) {
        self.0.notify_waiters();
    }

    pub(crate) fn next(&self) -> Notified<'_> {
        self.0.notified()
    }
}

impl ComponentState {
    /// Must be called inside a tokio runtime. `is_test`: the component is one of the two in a unit test.
    pub(crate) fn new(
        spec: &'static ComponentSpec,
        registration: Box<dyn RegisteredComponent>,
        stats: Option<(ComponentStats, StatsWriter)>,
        runtime: Option<Arc<OwnedRuntime>>,
        is_test: bool,
    ) -> Self {
        let handle = Handle::current();
        let runtime_ended = Arc::new(AtomicBool::new(false));
        let (keep, ended) = (registration.keep(), SetOnDrop(Arc::clone(&runtime_ended)));
        let keeper = AbortOnDrop::spawn(&handle, async move {
            keep.await;
            // Held by a task that never ends, so it is dropped with the runtime.
            let _ended = ended;
            std::future::pending::<()>().await;
        });
        let (monitor, stats) = monitor::start(spec, stats, &handle);
        let member = service::join(|| reported::follows_calls(runtime.is_some(), &handle));
        Self {
            spec,
            process: ProcessMark::new(),
            changes: Changes::default(),
            ends: Mutex::default(),
            receiving: Mutex::default(),
            given_up: Mutex::default(),
            flushed: Mutex::default(),
            runtime,
            handle,
            runtime_ended,
            calls_ended: AtomicBool::new(false),
            is_test,
            #[cfg(feature = "protobuf")]
            message_types: OnceLock::new(),
            waiting_calls: Mutex::default(),
            monitor,
            parameters: Values::default(),
            setter: OnceLock::new(),
            _stats: stats,
            member,
            reporting: OnceLock::new(),
            owners: AtomicUsize::new(0),
            _keeper: keeper,
            registration,
        }
    }

    /// Returns the message types of `schemas:`, if there are any.
    #[cfg(feature = "protobuf")]
    pub(crate) fn message_types(&self) -> Option<&FileDescriptorSet> {
        let decode = || scl_shape::decode(self.spec.schema?.descriptors).ok();
        self.message_types.get_or_init(decode).as_ref()
    }

    pub(crate) fn changes(&self) -> Changes {
        self.changes.clone()
    }

    /// Drives an end in a task, so that its connection makes progress whether its gate is used or not.
    pub(crate) fn drive<E: SendingEnd + 'static>(&self, end: E) -> Arc<Mutex<E>> {
        let end = Arc::new(Mutex::new(end));
        // The task holds the end weakly, so that the end is dropped with its gate, and not only when the runtime drops
        // the task.
        let task = AbortOnDrop::drive(&self.handle, &end, |end, cx| lock(end).drive(cx));
        lock(&self.ends).push(Registered { end: Arc::clone(&end) as _, _task: Some(task) });
        end
    }

    /// Makes an end that its gate drives take part in flushing.
    pub(crate) fn register(&self, end: Arc<Mutex<dyn SendingEnd>>) {
        lock(&self.ends).push(Registered { end, _task: None });
    }

    /// Makes an end acknowledge what its program has received when the component is closed. Gates that are dropped do
    /// so themselves.
    pub(crate) fn register_receiving(&self, end: Weak<Mutex<dyn ReceivingEnd>>) {
        lock(&self.receiving).push(end);
    }

    /// Acknowledges what the program has received, because it is about to end, perhaps without dropping its gates.
    fn acknowledge_last(&self) {
        let ends = lock(&self.receiving).iter().filter_map(Weak::upgrade).collect::<Vec<_>>();
        ends.iter().for_each(|end| lock(end).acknowledge_last());
    }

    /// Releases the end of a dropped gate: drops it as soon as its peer has taken everything, or after [`LINGER`]. A
    /// flush of the component, which has a limit of its own, keeps it longer.
    pub(crate) fn release(self: &Arc<Self>, end: Arc<Mutex<dyn SendingEnd>>) {
        // Ends enter the runtime, which is impossible on a thread that is ending.
        on_living_thread(|| self.release_here(&end));
    }

    fn release_here(self: &Arc<Self>, end: &Arc<Mutex<dyn SendingEnd>>) {
        if self.runtime_ended.load(Ordering::Acquire) {
            // Dropping the component hands over what is left.
            return;
        }
        if self.is_done(end) {
            // Messages for a peer that is not running are reported when the component is closed.
            let waiting = lock(end).waits_for_absent_peer();
            lock(&self.given_up).extend(waiting);
            return self.remove(end);
        }
        // Weak, so that the socket is freed when the component is dropped, and not only when the runtime drops the
        // task.
        let (state, end) = (Arc::downgrade(self), Arc::downgrade(end));
        self.handle.spawn(async move {
            let done = poll_fn(|cx| match (state.upgrade(), end.upgrade()) {
                (Some(state), Some(end)) => state.poll_done(&end, cx),
                _ => Poll::Ready(()),
            });
            let in_time = tokio::time::timeout(LINGER, done).await.is_ok();
            if let (Some(state), Some(end)) = (state.upgrade(), end.upgrade()) {
                if !in_time && *lock(&state.flushed) {
                    return;
                }
                let left = flush::leftover(&mut *lock(&end), Flush::Running, true);
                lock(&state.given_up).extend(left);
                state.remove(&end);
            }
        });
    }

    fn remove(&self, end: &Arc<Mutex<dyn SendingEnd>>) {
        let removed = {
            let mut ends = lock(&self.ends);
            let place = ends.iter().position(|one| Arc::ptr_eq(&one.end, end));
            place.map(|place| ends.swap_remove(place))
        };
        drop(removed);
    }

    /// Returns true in a forked child: the component belongs to its parent.
    pub(crate) fn is_inherited(&self) -> bool {
        !self.process.is_own()
    }

    /// Explains why peers are missing, for error texts: `` `sensor` is not running ``. Returns `None` if none is.
    pub(crate) fn why_missing(&self, gate: &GateSpec, missing: &[Missing]) -> Option<String> {
        let reasons = missing.iter().map(|missing| self.explain(gate, missing));
        let reasons: Vec<String> = reasons.collect();
        (!reasons.is_empty()).then(|| reasons.join("; "))
    }

    /// Explains why a peer is missing, as a sentence.
    pub(crate) fn explain(&self, gate: &GateSpec, missing: &Missing) -> String {
        let Missing { connection, refusal } = missing;
        let reason = || self.registration.explain_missing(gate, connection);
        refusal.clone().unwrap_or_else(|| format!("{} {}", PeerName::of(connection), reason()))
    }

    /// Returns true if another process runs a component. A component of this process cannot be waited for, because the
    /// waiting thread may be the one that runs it.
    fn runs_elsewhere(&self, component: &str) -> bool {
        self.registration.neighbour(component) == Some(Neighbour::OtherProcess)
    }

    /// Waits until peers have taken everything, at most for a given time.
    pub(crate) async fn flush(&self, flush: Flush, timeout: Duration) -> Result<(), NotFlushed> {
        *lock(&self.flushed) = true;
        let flush = self.awaited(flush);
        let _waiting = self.waiting();
        let started = Instant::now();
        let ends = self.ends();
        let mut left = flush::flush(&ends, flush, timeout, &|component| self.runs_elsewhere(component)).await;
        let mut given_up = std::mem::take(&mut *lock(&self.given_up));
        if flush == Flush::Running {
            left.append(&mut given_up);
        }
        self.flushed_in(started.elapsed(), left)
    }

    /// [`flush`](Self::flush) from a plain thread. Works after a stop request, too.
    pub(crate) fn flush_blocking(&self, flush: Flush, timeout: Duration) -> Result<(), NotFlushed> {
        match runtime::refuse_to_wait() {
            // Do not use another thread unless necessary: while `dlclose` runs a destructor, it holds a lock that new
            // threads wait for.
            Ok(()) => self.flush_here(flush, timeout),
            // Called in the destructor of a thread-local value, or in an `atexit` handler.
            Err(BlockingError::ThreadEnding) => on_another_thread(|| self.flush_here(flush, timeout)),
            Err(_) => Ok(()),
        }
    }

    fn flush_here(&self, flush: Flush, timeout: Duration) -> Result<(), NotFlushed> {
        match &self.runtime {
            Some(runtime) => runtime.block_on(self.flush(flush, timeout)).unwrap_or(Ok(())),
            None => {
                *lock(&self.flushed) = true;
                let flush = self.awaited(flush);
                let started = Instant::now();
                let is_running = |component: &str| self.runs_elsewhere(component);
                let left = flush::flush_detached(&self.ends(), flush, true, timeout, &is_running);
                self.flushed_in(started.elapsed(), left)
            }
        }
    }

    /// Returns which peers to wait for: in a unit test only connected ones, because a peer that is gone will not come
    /// back.
    fn awaited(&self, flush: Flush) -> Flush {
        if self.is_test { Flush::Connected } else { flush }
    }

    /// Ends a flush. A unit test need not receive everything.
    fn flushed_in(&self, waited: Duration, left: Vec<Unflushed>) -> Result<(), NotFlushed> {
        self.acknowledge_last();
        let flushed = NotFlushed::of(self.spec.name, left, waited, &|component| self.runs_elsewhere(component));
        flushed.or_else(|left| if self.is_test && !left.is_failure() { Ok(()) } else { Err(left) })
    }

    /// Hands over the messages left in a component that is dropped, and logs those that no peer takes.
    fn hand_over(&self, ends: &[Arc<Mutex<dyn SendingEnd>>]) {
        if *lock(&self.flushed) {
            return;
        }
        let is_running = |component: &str| self.runs_elsewhere(component);
        let left = flush::flush_detached(ends, self.awaited(Flush::Running), false, LINGER, &is_running);
        let left = left.into_iter().filter(|_| !self.is_test);
        for left in lock(&self.given_up).drain(..).chain(left) {
            log::warn(&format!("component `{}` was dropped with messages left: {left}", self.spec.name));
        }
    }

    fn ends(&self) -> Vec<Arc<Mutex<dyn SendingEnd>>> {
        lock(&self.ends).iter().map(|one| Arc::clone(&one.end)).collect()
    }

    fn is_done(&self, end: &Mutex<dyn SendingEnd>) -> bool {
        self.poll_done(end, &mut Context::from_waker(Waker::noop())).is_ready()
    }

    fn poll_done(&self, end: &Mutex<dyn SendingEnd>, cx: &mut Context<'_>) -> Poll<()> {
        let mut end = lock(end);
        let flushed = end.poll_flushed(true, cx).is_ready();
        let awaited = end.waits_for_absent_peer().is_some_and(|left| self.runs_elsewhere(left.peer.component()));
        if flushed && !awaited { Poll::Ready(()) } else { Poll::Pending }
    }
}

/// Hands over the messages left, within [`LINGER`], on the calling thread unless it is ending, and without a runtime.
impl Drop for ComponentState {
    fn drop(&mut self) {
        debug_assert!(!self.is_inherited(), "an owner keeps what a forked child inherits");
        drop(self.setter.take());
        let ends = std::mem::take(&mut *lock(&self.ends));
        let ends: Vec<_> = ends.into_iter().map(|one| one.end).collect();
        on_living_thread(|| self.hand_over(&ends));
        // The tasks of the ends have been aborted, but one may be in the middle of a poll. The sockets must be closed
        // before the component's lock is released.
        ends.iter().for_each(await_other_users);
        // Who waits without keeping the component open finds it closed.
        self.changes.report();
    }
}

impl std::fmt::Debug for ComponentState {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("ComponentState").field(&self.spec.name).finish()
    }
}
