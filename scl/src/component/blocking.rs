//! Waiting for gates in a program without async.
//!
//! The component owns a runtime. A blocking call drives it itself, so that no message crosses a thread; while the
//! program makes no call, a thread of the component drives it, so that late peers are served and queues follow. The
//! thread takes over some [`IDLE`] after the last call: in a loop at 1 kHz it never does. So a call that has nothing to
//! wait for gives the runtime a turn now and then, or else nobody would let a late peer in.

use crate::error::{BlockingError, OpenError};
use crate::sync::lock;
use std::future::poll_fn;
use std::pin::pin;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Wake};
use std::thread::{self, Thread};
use std::time::{Duration, Instant};
use tokio::runtime::{Builder, EnterGuard, Handle, Runtime};
use tokio::sync::Notify;
use tokio::task::yield_now;

const IDLE: Duration = Duration::from_millis(2);
/// How long the idle thread rests at most while calls follow each other: each time it looks costs one of them a wake-up.
const LONGEST_REST: Duration = Duration::from_millis(16);
/// How long calls that wait for nothing may follow each other without a turn of the runtime.
const TURN: Duration = Duration::from_millis(1);

/// The runtime of a component that was opened without async.
#[derive(Debug)]
pub(crate) struct OwnedRuntime {
    shared: Arc<Shared>,
    handle: Handle,
}

#[derive(Debug)]
struct Shared {
    /// `None` only while the component is being dropped.
    runtime: Mutex<Option<Runtime>>,
    /// Calls that want the runtime now.
    callers: AtomicUsize,
    /// Whether the idle thread drives the runtime, and wants to be told to give it back.
    idle_drives: AtomicBool,
    wanted: Notify,
    ended: AtomicBool,
    opened: Instant,
    last_call: Moment,
    last_turn: Moment,
    /// Where the idle thread rests, and whether it is to be woken by the end of a call.
    rest: Mutex<()>,
    awaits_end: AtomicBool,
    called: Condvar,
}

/// A time since the component was opened.
#[derive(Debug, Default)]
struct Moment(AtomicU64);

impl Moment {
    fn set(&self, since_opened: Duration) {
        self.0.store(since_opened.as_nanos() as u64, Ordering::SeqCst);
    }

    fn get(&self) -> Duration {
        Duration::from_nanos(self.0.load(Ordering::SeqCst))
    }
}

impl OwnedRuntime {
    pub(super) fn start(component: &'static str) -> Result<Arc<Self>, OpenError> {
        let failed = |source| OpenError::Runtime { component, source };
        let runtime = Builder::new_current_thread().enable_all().build().map_err(failed)?;
        let handle = runtime.handle().clone();
        let shared = Arc::new(Shared {
            runtime: Mutex::new(Some(runtime)),
            callers: AtomicUsize::new(0),
            idle_drives: AtomicBool::new(false),
            wanted: Notify::new(),
            ended: AtomicBool::new(false),
            opened: Instant::now(),
            last_call: Moment::default(),
            last_turn: Moment::default(),
            rest: Mutex::default(),
            awaits_end: AtomicBool::new(false),
            called: Condvar::new(),
        });
        let idle = Arc::clone(&shared);
        thread::Builder::new().name("scl-idle".to_owned()).spawn(move || idle.drive_while_idle()).map_err(failed)?;
        Ok(Arc::new(Self { shared, handle }))
    }

    pub(super) fn enter(&self) -> EnterGuard<'_> {
        self.handle.enter()
    }

    /// Drives the runtime until a future is ready, or the program is told to stop.
    pub(super) fn block_on<F: Future>(&self, future: F) -> Result<F::Output, BlockingError> {
        self.drive_until(super::main::until_stopped(future))?
    }

    /// Drives the runtime until a future is ready.
    pub(super) fn drive_until<F: Future>(&self, future: F) -> Result<F::Output, BlockingError> {
        refuse_inside_async()?;
        self.lend(|runtime| match runtime {
            Some(runtime) => Ok(runtime.block_on(self.shared.with_a_turn(future))),
            None => Err(BlockingError::Stopped),
        })
    }

    /// Does something where waking a task takes no other thread, and then runs what it woke. Inside async code, where the
    /// runtime cannot be driven, the idle thread runs that a little later.
    pub(super) fn act<R>(&self, act: impl FnOnce() -> R) -> R {
        if refuse_inside_async().is_err() {
            return act();
        }
        self.lend(|runtime| match runtime {
            Some(runtime) => runtime.block_on(self.shared.with_a_turn(async {
                let done = act();
                yield_now().await;
                done
            })),
            None => act(),
        })
    }

    /// Takes the runtime from the idle thread for a call; it is `None` only while the component is being dropped.
    fn lend<R>(&self, call: impl FnOnce(Option<&Runtime>) -> R) -> R {
        let shared = &self.shared;
        shared.callers.fetch_add(1, Ordering::SeqCst);
        if shared.idle_drives.load(Ordering::SeqCst) {
            shared.wanted.notify_one();
        }
        let runtime = lock(&shared.runtime);
        let returned = call(runtime.as_ref());
        drop(runtime);
        shared.callers.fetch_sub(1, Ordering::SeqCst);
        shared.last_call.set(shared.opened.elapsed());
        if shared.awaits_end.load(Ordering::SeqCst) {
            shared.wake_idle_thread();
        }
        returned
    }
}

impl Drop for OwnedRuntime {
    fn drop(&mut self) {
        self.shared.ended.store(true, Ordering::SeqCst);
        self.shared.wanted.notify_one();
        self.shared.wake_idle_thread();
        if let Some(runtime) = lock(&self.shared.runtime).take() {
            // Waiting for its threads would be refused inside async code; it has none that matter.
            runtime.shutdown_background();
        }
    }
}

impl Shared {
    /// The future's result; if it had nothing to wait for, then after a turn of the runtime where one is due.
    async fn with_a_turn<F: Future>(&self, future: F) -> F::Output {
        let mut future = pin!(future);
        let mut waited = false;
        let ready = poll_fn(|cx| {
            let polled = future.as_mut().poll(cx);
            waited |= polled.is_pending();
            polled
        })
        .await;
        let now = self.opened.elapsed();
        let due = now.saturating_sub(self.last_turn.get()) >= TURN;
        if waited || due {
            self.last_turn.set(now);
        }
        if due && !waited {
            // The first lets the runtime look what has happened, the second runs what that woke.
            yield_now().await;
            yield_now().await;
        }
        ready
    }

    fn drive_while_idle(&self) {
        while !self.ended.load(Ordering::SeqCst) {
            self.wait_until_idle();
            let runtime = lock(&self.runtime);
            self.idle_drives.store(true, Ordering::SeqCst);
            // A call that comes from now on sees that it has to ask for the runtime.
            if let Some(runtime) = &*runtime
                && self.callers.load(Ordering::SeqCst) == 0
            {
                runtime.block_on(self.wanted.notified());
            }
            self.idle_drives.store(false, Ordering::SeqCst);
        }
    }

    /// Returns when there was no call for a while.
    fn wait_until_idle(&self) {
        let mut rest = lock(&self.rest);
        let (mut pause, mut seen) = (IDLE, self.last_call.get());
        while !self.ended.load(Ordering::SeqCst) {
            let last_call = self.last_call.get();
            let busy = self.callers.load(Ordering::SeqCst) > 0;
            if !busy && self.opened.elapsed().saturating_sub(last_call) >= IDLE {
                return;
            }
            let calls_follow = std::mem::replace(&mut seen, last_call) != last_call;
            pause = if calls_follow { LONGEST_REST.min(pause * 2) } else { IDLE };
            rest = if busy && !calls_follow {
                self.wait_for_end_of_call(rest)
            } else {
                self.called.wait_timeout(rest, pause).unwrap_or_else(PoisonError::into_inner).0
            };
        }
    }

    /// Waits however long a call takes.
    fn wait_for_end_of_call<'r>(&self, rest: MutexGuard<'r, ()>) -> MutexGuard<'r, ()> {
        self.awaits_end.store(true, Ordering::SeqCst);
        // A call that has ended before it could see this is not waited for.
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

/// Waits on a plain thread while the component's own runtime runs elsewhere.
pub(super) fn wait_beside<F: Future>(future: F) -> Result<F::Output, BlockingError> {
    refuse_inside_async()?;
    struct Unpark(Thread);
    impl Wake for Unpark {
        fn wake(self: Arc<Self>) {
            self.0.unpark();
        }
    }
    let waker = Arc::new(Unpark(thread::current())).into();
    let mut cx = Context::from_waker(&waker);
    let mut future = pin!(super::main::until_stopped(future));
    loop {
        if let Poll::Ready(ready) = future.as_mut().poll(&mut cx) {
            return ready;
        }
        thread::park();
    }
}

fn refuse_inside_async() -> Result<(), BlockingError> {
    // A thread that only entered a runtime, as opening does, could wait; but nothing waits then.
    if Handle::try_current().is_ok() { Err(BlockingError::InsideAsync) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_that_wait_for_nothing_give_the_runtime_its_turns() {
        let owned = OwnedRuntime::start("sensor").unwrap();
        // As if the idle thread never got around to it.
        let _held = lock(&owned.shared.rest);
        let ran = Arc::new(AtomicBool::new(false));
        let task = Arc::clone(&ran);
        owned.handle.spawn(async move {
            yield_now().await;
            task.store(true, Ordering::SeqCst);
        });
        let call_until_it_ran =
            || (0..10_000_000).any(|_| owned.block_on(async { ran.load(Ordering::SeqCst) }).unwrap());
        assert!(call_until_it_ran());
    }
}
