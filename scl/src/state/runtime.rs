//! Waiting for gates in a program without async.
//!
//! The component owns a current-thread runtime. Every blocking call drives it itself, so that no message crosses a
//! thread; calls from several threads share it: one of them drives, and when that one returns, the next takes over.
//! While no call is under way, a thread of the component drives it, so that late peers are served and queues drain.
//! That thread takes over [`IDLE`] after the last call: in a loop at 1 kHz it never does. Calls that have nothing to
//! wait for give the runtime a turn now and then, or late peers would never be accepted.

use crate::error::{BlockingError, OpenError};
use crate::sync::{is_thread_ending, lock, unparks_this_thread};
use std::future::poll_fn;
use std::io;
use std::pin::pin;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};
use std::thread;
use std::time::{Duration, Instant};
use tokio::runtime::{Builder, EnterGuard, Handle, Runtime};
use tokio::sync::Notify;

const IDLE: Duration = Duration::from_millis(2);
/// The longest pause of the idle thread while calls follow each other; each time it checks for calls costs a wake-up.
const LONGEST_REST: Duration = Duration::from_millis(16);
/// How long calls that wait for nothing may follow each other without a turn of the runtime.
const TURN: Duration = Duration::from_millis(1);

/// The runtime of a component that was opened without async.
#[derive(Debug)]
pub(crate) struct OwnedRuntime {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    /// `None` once dropped, which may happen inside async code.
    runtime: Option<Runtime>,
    /// The waker with which the call that drives the runtime, and no other call, polls its future.
    driver: Waker,
    /// Number of calls that drive the runtime or want to.
    callers: AtomicUsize,
    /// Whether the idle thread drives the runtime, and must be told to give it back.
    idle_drives: AtomicBool,
    wanted: Notify,
    ended: AtomicBool,
    opened: Instant,
    last_call: AtomicDuration,
    last_turn: AtomicDuration,
    /// The mutex of `called`, on which the idle thread rests; and whether the end of a call must wake it.
    rest: Mutex<()>,
    awaits_end: AtomicBool,
    called: Condvar,
    /// Number of [`Driven`]s.
    driven: AtomicUsize,
}

impl Drop for Shared {
    fn drop(&mut self) {
        // Dropping the runtime waits for its threads, which panics inside async code. It has no threads that matter.
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_background();
        }
    }
}

/// A time since the component was opened.
#[derive(Debug, Default)]
struct AtomicDuration(AtomicU64);

impl AtomicDuration {
    fn set(&self, since_opened: Duration) {
        self.0.store(since_opened.as_nanos() as u64, Ordering::SeqCst);
    }

    fn get(&self) -> Duration {
        Duration::from_nanos(self.0.load(Ordering::SeqCst))
    }
}

impl OwnedRuntime {
    pub(crate) fn start(component: &'static str) -> Result<Arc<Self>, OpenError> {
        let failed = |source| OpenError::Runtime { component, source };
        if is_thread_ending() {
            return Err(failed(io::Error::other(BlockingError::ThreadEnding)));
        }
        // The program may keep its component in a thread-local value and close it in the destructor of that value.
        prepare_thread();
        let runtime = Builder::new_current_thread().enable_all().build().map_err(failed)?;
        let driver = waker_of_driver(&runtime).map_err(failed)?;
        let shared = Arc::new(Shared {
            runtime: Some(runtime),
            driver,
            callers: AtomicUsize::new(0),
            idle_drives: AtomicBool::new(false),
            wanted: Notify::new(),
            ended: AtomicBool::new(false),
            opened: Instant::now(),
            last_call: AtomicDuration::default(),
            last_turn: AtomicDuration::default(),
            rest: Mutex::default(),
            awaits_end: AtomicBool::new(false),
            called: Condvar::new(),
            driven: AtomicUsize::new(0),
        });
        let idle = Arc::clone(&shared);
        thread::Builder::new().name("scl-idle".to_owned()).spawn(move || idle.drive_while_idle()).map_err(failed)?;
        Ok(Arc::new(Self { shared }))
    }

    pub(crate) fn enter(&self) -> EnterGuard<'_> {
        self.shared.runtime().enter()
    }

    /// Drives the runtime until a future is ready.
    pub(super) fn block_on<F: Future>(&self, future: F) -> Result<F::Output, BlockingError> {
        refuse_to_wait()?;
        // Pinned here because tokio would allocate memory for a large future.
        let future = pin!(self.shared.with_a_turn(future));
        Ok(self.shared.call(|runtime| runtime.block_on(future)))
    }

    /// From now on the component's thread drives the runtime whenever no call does, without a delay.
    pub(super) fn drive_always(&self) -> Driven {
        self.shared.driven.fetch_add(1, Ordering::SeqCst);
        self.shared.wake_idle_thread();
        Driven(Arc::clone(&self.shared))
    }

    /// Returns true if the component's thread drives the runtime whenever no call does.
    pub(super) fn is_driven(&self) -> bool {
        self.shared.is_driven()
    }

    /// Gives the runtime a turn if one is due. Inside async code, where it cannot be driven, the idle thread does that
    /// a little later.
    pub(super) fn take_turn(&self) {
        if !self.is_driven() && self.shared.is_turn_due() && refuse_to_wait().is_ok() {
            self.shared.call(|runtime| runtime.block_on(self.shared.with_a_turn(async {})));
        }
    }
}

/// Keeps the runtime driven by the component's thread, for an event loop that waits for gates without a call that would
/// drive it.
#[derive(Debug)]
pub(crate) struct Driven(Arc<Shared>);

impl Drop for Driven {
    fn drop(&mut self) {
        self.0.driven.fetch_sub(1, Ordering::SeqCst);
    }
}

impl Drop for OwnedRuntime {
    fn drop(&mut self) {
        self.shared.ended.store(true, Ordering::SeqCst);
        self.shared.wanted.notify_one();
        self.shared.wake_idle_thread();
    }
}

impl Shared {
    fn runtime(&self) -> &Runtime {
        match &self.runtime {
            Some(runtime) => runtime,
            None => unreachable!("the runtime is taken only when it is dropped"),
        }
    }

    /// Lets a call use the runtime, which the idle thread gives back for it.
    fn call<R>(&self, call: impl FnOnce(&Runtime) -> R) -> R {
        self.callers.fetch_add(1, Ordering::SeqCst);
        // A guard, so that the count drops even if the call panics.
        let _called = Called(self);
        if self.idle_drives.load(Ordering::SeqCst) {
            self.wanted.notify_one();
        }
        call(self.runtime())
    }

    fn is_driven(&self) -> bool {
        self.driven.load(Ordering::SeqCst) > 0
    }

    fn is_turn_due(&self) -> bool {
        self.opened.elapsed().saturating_sub(self.last_turn.get()) >= TURN
    }

    /// Awaits a future. If it had nothing to wait for, gives the runtime a turn afterwards if one is due.
    async fn with_a_turn<F: Future>(&self, future: F) -> F::Output {
        let mut future = pin!(future);
        let mut had_turn = false;
        let ready = poll_fn(|cx| {
            let polled = future.as_mut().poll(cx);
            had_turn |= polled.is_pending() && self.is_driven_with(cx);
            polled
        })
        .await;
        if !had_turn && self.is_turn_due() {
            // The first turn polls the I/O driver; the second runs the tasks it woke.
            had_turn = self.give_a_turn().await && self.give_a_turn().await;
        }
        if had_turn {
            self.last_turn.set(self.opened.elapsed());
        }
        ready
    }

    /// Like tokio's `yield_now`, but allocates no memory. Returns false if the runtime had no turn, because another
    /// call has it and perhaps waits for its own socket.
    async fn give_a_turn(&self) -> bool {
        let mut had_turn = None;
        poll_fn(|cx| match had_turn {
            Some(had_turn) => Poll::Ready(had_turn),
            None => {
                had_turn = Some(self.is_driven_with(cx));
                cx.waker().wake_by_ref();
                Poll::Pending
            }
        })
        .await
    }

    fn is_driven_with(&self, cx: &Context<'_>) -> bool {
        cx.waker().will_wake(&self.driver)
    }

    fn drive_while_idle(&self) {
        // Prepare at once: a thread that creates its first thread-local value blocks while `dlclose` runs a destructor,
        // and that destructor may be waiting for this thread.
        prepare_thread();
        while !self.ended.load(Ordering::SeqCst) {
            self.wait_until_idle();
            self.idle_drives.store(true, Ordering::SeqCst);
            // A call that starts from now on sees that it has to ask for the runtime.
            if self.callers.load(Ordering::SeqCst) == 0 && !self.ended.load(Ordering::SeqCst) {
                self.runtime().block_on(self.wanted.notified());
            }
            self.idle_drives.store(false, Ordering::SeqCst);
        }
    }

    /// Returns when no call has been made for a while.
    fn wait_until_idle(&self) {
        let mut rest = lock(&self.rest);
        let (mut pause, mut seen) = (IDLE, self.last_call.get());
        while !self.ended.load(Ordering::SeqCst) {
            let last_call = self.last_call.get();
            let busy = self.callers.load(Ordering::SeqCst) > 0;
            let driven = self.is_driven();
            if !busy && (driven || self.opened.elapsed().saturating_sub(last_call) >= IDLE) {
                return;
            }
            let calls_follow = std::mem::replace(&mut seen, last_call) != last_call;
            pause = if calls_follow { LONGEST_REST.min(pause * 2) } else { IDLE };
            rest = if busy && (driven || !calls_follow) {
                self.wait_for_end_of_call(rest)
            } else {
                self.called.wait_timeout(rest, pause).unwrap_or_else(PoisonError::into_inner).0
            };
        }
    }

    /// Waits until no call is under way, however long that takes.
    fn wait_for_end_of_call<'r>(&self, rest: MutexGuard<'r, ()>) -> MutexGuard<'r, ()> {
        self.awaits_end.store(true, Ordering::SeqCst);
        // Check for calls only now: a call that ended before it could see the flag does not wake this thread.
        let awaits = |_: &mut ()| self.callers.load(Ordering::SeqCst) > 0 && !self.ended.load(Ordering::SeqCst);
        let rest = self.called.wait_while(rest, awaits).unwrap_or_else(PoisonError::into_inner);
        self.awaits_end.store(false, Ordering::SeqCst);
        rest
    }

    fn wake_idle_thread(&self) {
        let _rest = lock(&self.rest);
        self.called.notify_one();
    }
}

/// Counts a call as ended when dropped.
struct Called<'a>(&'a Shared);

impl Drop for Called<'_> {
    fn drop(&mut self) {
        let shared = self.0;
        shared.callers.fetch_sub(1, Ordering::SeqCst);
        shared.last_call.set(shared.opened.elapsed());
        if shared.awaits_end.load(Ordering::SeqCst) {
            shared.wake_idle_thread();
        }
    }
}

/// Returns the waker with which a runtime polls the future of the call that drives it. The runtime must not be in use
/// yet.
fn waker_of_driver(runtime: &Runtime) -> io::Result<Waker> {
    thread::scope(|threads| {
        // On a thread of its own, because this one may be inside another runtime.
        let clone = || runtime.block_on(poll_fn(|cx| Poll::Ready(cx.waker().clone())));
        let cloned = thread::Builder::new().spawn_scoped(threads, clone)?.join();
        cloned.map_err(|_panic| io::Error::other("the runtime cannot be driven"))
    })
}

/// Waits for a future on a plain thread while the runtime of the component runs elsewhere.
pub(super) fn park_until<F: Future>(future: F) -> F::Output {
    park_until_or(Duration::MAX, future).unwrap_or_else(|| unreachable!("no time is as long"))
}

/// Like [`park_until`], but gives up after a given time and then returns `None`. The runtime may have ended, so its
/// timers cannot be used here.
pub(super) fn park_until_or<F: Future>(time: Duration, future: F) -> Option<F::Output> {
    let started = Instant::now();
    let mut future = pin!(future);
    let waker = unparks_this_thread();
    let mut cx = Context::from_waker(&waker);
    loop {
        if let Poll::Ready(ready) = future.as_mut().poll(&mut cx) {
            return Some(ready);
        }
        let left = time.checked_sub(started.elapsed()).filter(|left| !left.is_zero())?;
        thread::park_timeout(left);
    }
}

/// Creates the thread-local values of the calling thread that calls to components need. For bindings whose programs
/// make calls in destructors and at their exit: a thread-local value that the binding creates after this call is
/// destroyed before those, so its destructor shows from when on calls have to be made on another thread.
pub fn prepare_thread() {
    // This creates tokio's thread-local values, which are then destroyed after those that the thread creates later.
    if refuse_to_wait().is_ok()
        && let Ok(runtime) = Builder::new_current_thread().build()
    {
        // `Handle::block_on` waits like a call while another call drives the runtime, which creates one more
        // thread-local value.
        runtime.handle().block_on(async {});
    }
}

/// Fails on a thread that must not wait: inside async code, and while its thread-local values are destroyed.
pub(super) fn refuse_to_wait() -> Result<(), BlockingError> {
    match Handle::try_current() {
        // This includes threads that have merely entered a runtime, and could block. Opening a component enters one,
        // but does not block.
        Ok(_) => Err(BlockingError::InsideAsync),
        // tokio panics if a thread that is ending drives a runtime or creates a timer.
        Err(_) if is_thread_ending() => Err(BlockingError::ThreadEnding),
        Err(_) => Ok(()),
    }
}

#[cfg(test)]
mod tests;
