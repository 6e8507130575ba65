//! Waiting for gates in a program without async.
//!
//! The component owns a runtime. A blocking call drives it itself, so that no message crosses a thread; while the
//! program makes no call, a thread of the component drives it, so that late peers are served and queues follow. The
//! thread takes over only after [`IDLE`] without a call: in a loop at 1 kHz it never does.

use crate::error::{BlockingError, OpenError};
use crate::sync::lock;
use std::pin::pin;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::task::{Context, Poll, Wake};
use std::thread::{self, Thread};
use std::time::{Duration, Instant};
use tokio::runtime::{Builder, EnterGuard, Handle, Runtime};
use tokio::sync::Notify;

const IDLE: Duration = Duration::from_millis(2);

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
    /// Tells the idle thread to give the runtime back.
    wanted: Notify,
    ended: AtomicBool,
    last_call: Mutex<Instant>,
    called: Condvar,
}

impl OwnedRuntime {
    pub(super) fn start(component: &'static str) -> Result<Arc<Self>, OpenError> {
        let failed = |source| OpenError::Runtime { component, source };
        let runtime = Builder::new_current_thread().enable_all().build().map_err(failed)?;
        let handle = runtime.handle().clone();
        let shared = Arc::new(Shared {
            runtime: Mutex::new(Some(runtime)),
            callers: AtomicUsize::new(0),
            wanted: Notify::new(),
            ended: AtomicBool::new(false),
            last_call: Mutex::new(Instant::now()),
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
        self.shared.callers.fetch_add(1, Ordering::SeqCst);
        self.shared.wanted.notify_one();
        let runtime = lock(&self.shared.runtime);
        let ready = match &*runtime {
            Some(runtime) => Ok(runtime.block_on(future)),
            None => Err(BlockingError::Stopped),
        };
        drop(runtime);
        self.shared.callers.fetch_sub(1, Ordering::SeqCst);
        *lock(&self.shared.last_call) = Instant::now();
        self.shared.called.notify_one();
        ready
    }
}

impl Drop for OwnedRuntime {
    fn drop(&mut self) {
        self.shared.ended.store(true, Ordering::SeqCst);
        self.shared.wanted.notify_one();
        self.shared.called.notify_one();
        if let Some(runtime) = lock(&self.shared.runtime).take() {
            // Waiting for its threads would be refused inside async code; it has none that matter.
            runtime.shutdown_background();
        }
    }
}

impl Shared {
    fn drive_while_idle(&self) {
        while !self.ended.load(Ordering::SeqCst) {
            self.wait_until_idle();
            let runtime = lock(&self.runtime);
            if let Some(runtime) = &*runtime
                && self.callers.load(Ordering::SeqCst) == 0
            {
                runtime.block_on(self.wanted.notified());
            }
        }
    }

    /// Returns when there was no call for a while.
    fn wait_until_idle(&self) {
        let mut last_call = lock(&self.last_call);
        while !self.ended.load(Ordering::SeqCst) {
            let quiet = last_call.elapsed();
            let busy = self.callers.load(Ordering::SeqCst) > 0;
            if quiet >= IDLE && !busy {
                return;
            }
            // A call in progress ends this wait by itself, however long it takes.
            let pause = if busy { Duration::from_secs(3600) } else { IDLE - quiet };
            last_call = self.called.wait_timeout(last_call, pause).unwrap_or_else(|error| error.into_inner()).0;
        }
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
