//! Small helpers for threads and tasks that several modules need.

use scl_fork::ProcessMark;
use std::future::poll_fn;
use std::panic::resume_unwind;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::task::{Context, Poll, Wake, Waker};
use std::thread::{self, ScopedJoinHandle, Thread};
use std::time::{Duration, Instant};
use tokio::runtime::Handle;
use tokio::task::AbortHandle;

/// How long to wait for tasks that use a value at this moment, each for no longer than one poll.
const LAST_USE: Duration = Duration::from_secs(1);
const PAUSE: Duration = Duration::from_micros(20);

/// Locks a mutex. A panic while it was locked elsewhere does not spread, since no lock here guards a half-done change.
pub(crate) fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Locks a mutex without waiting. Returns `None` while another thread holds the lock.
pub(crate) fn try_lock<T: ?Sized>(mutex: &Mutex<T>) -> Option<MutexGuard<'_, T>> {
    match mutex.try_lock() {
        Ok(guard) => Some(guard),
        Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => None,
    }
}

/// Returns true if tokio's thread-local values of the calling thread, without which it cannot wait, have been
/// destroyed.
pub(crate) fn is_thread_ending() -> bool {
    Handle::try_current().is_err_and(|error| error.is_thread_local_destroyed())
}

/// Makes a call here or, if the calling thread is ending, on another one.
pub(crate) fn on_living_thread<T: Send>(call: impl Fn() -> T + Sync) -> T {
    if is_thread_ending() { on_another_thread(call) } else { call() }
}

/// Makes a call on a new thread, whose thread-local values exist, and waits for it.
pub(crate) fn on_another_thread<T: Send>(call: impl Fn() -> T + Sync) -> T {
    thread::scope(|threads| {
        let spawned = thread::Builder::new().spawn_scoped(threads, &call);
        match spawned.map(ScopedJoinHandle::join) {
            Ok(Ok(result)) => result,
            Ok(Err(panic)) => resume_unwind(panic),
            // If no thread can be started, try on this one.
            Err(_) => call(),
        }
    })
}

/// Waits until this is the only strong reference to a value, so that dropping it drops the value, but at most
/// [`LAST_USE`]. Tasks hold weak references, which they upgrade only for a moment.
pub(crate) fn await_other_users<T: ?Sized>(value: &Arc<T>) {
    let started = Instant::now();
    while Arc::strong_count(value) > 1 && started.elapsed() < LAST_USE {
        thread::sleep(PAUSE);
    }
}

/// Keeps the waker of a task. Cheap if that waker is kept already, as it usually is.
pub(crate) fn keep_waker(kept: &mut Option<Waker>, waker: &Waker) {
    match kept {
        Some(kept) => kept.clone_from(waker),
        None => *kept = Some(waker.clone()),
    }
}

/// Returns a waker that unparks the calling thread.
pub(crate) fn unparks_this_thread() -> Waker {
    struct Unpark(Thread);

    impl Wake for Unpark {
        fn wake(self: Arc<Self>) {
            self.0.unpark();
        }
    }

    Arc::new(Unpark(thread::current())).into()
}

/// Aborts a task when dropped. In a forked child, the task and its runtime belong to the parent, and dropping does
/// nothing.
#[derive(Debug)]
pub(crate) struct AbortOnDrop {
    task: AbortHandle,
    process: ProcessMark,
}

impl AbortOnDrop {
    pub(crate) fn spawn(runtime: &Handle, task: impl Future<Output = ()> + Send + 'static) -> Self {
        Self { task: runtime.spawn(task).abort_handle(), process: ProcessMark::new() }
    }

    /// Spawns a task that drives an end as long as the end exists. The task holds it weakly, so that the end is dropped
    /// with its gate, and not only when the runtime drops the task.
    pub(crate) fn drive<E: Send + Sync + 'static>(
        runtime: &Handle,
        end: &Arc<E>,
        drive: impl Fn(&E, &mut Context<'_>) + Send + 'static,
    ) -> Self {
        let end = Arc::downgrade(end);
        let driven = poll_fn(move |cx| match end.upgrade() {
            Some(end) => {
                drive(&end, cx);
                Poll::Pending
            }
            None => Poll::Ready(()),
        });
        Self::spawn(runtime, driven)
    }
}

impl Drop for AbortOnDrop {
    fn drop(&mut self) {
        if self.process.is_own() {
            self.task.abort();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::future::pending;

    #[tokio::test]
    async fn a_task_ends_with_its_owner_but_not_in_a_forked_child() {
        for is_inherited in [true, false] {
            let mut owner = AbortOnDrop::spawn(&Handle::current(), pending());
            let task = owner.task.clone();
            if is_inherited {
                owner.process = ProcessMark::inherited();
            }
            drop(owner);
            // A task that was aborted is dropped in the next turn.
            tokio::task::yield_now().await;
            assert_eq!(task.is_finished(), !is_inherited);
        }
    }
}
