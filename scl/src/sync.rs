//! Small things about threads and tasks that several parts need.

use scl_fork::ProcessMark;
use std::panic::resume_unwind;
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread::{self, ScopedJoinHandle};
use tokio::runtime::Handle;
use tokio::task::AbortHandle;

/// Locks; a panic elsewhere while it was locked does not spread, since no lock here guards a half-done change.
pub(crate) fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Locks without waiting; `None` while another thread holds the lock.
pub(crate) fn try_lock<T: ?Sized>(mutex: &Mutex<T>) -> Option<MutexGuard<'_, T>> {
    match mutex.try_lock() {
        Ok(guard) => Some(guard),
        Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => None,
    }
}

/// Returns true if thread-local values of the calling thread are destroyed: tokio's, without which it cannot wait.
pub(crate) fn is_thread_ending() -> bool {
    Handle::try_current().is_err_and(|error| error.is_thread_local_destroyed())
}

/// Makes a call on a thread of its own, which has its thread-local values, and waits for it.
pub(crate) fn on_another_thread<T: Send>(call: impl Fn() -> T + Sync) -> T {
    thread::scope(|threads| {
        let spawned = thread::Builder::new().spawn_scoped(threads, &call);
        match spawned.map(ScopedJoinHandle::join) {
            Ok(Ok(result)) => result,
            Ok(Err(panic)) => resume_unwind(panic),
            // Without a thread, this one may do.
            Err(_) => call(),
        }
    })
}

/// Ends a task with its owner. In a forked child the task and its runtime are the parent's, and dropping does nothing.
#[derive(Debug)]
pub(crate) struct AbortOnDrop {
    task: AbortHandle,
    process: ProcessMark,
}

impl AbortOnDrop {
    pub(crate) fn new(task: AbortHandle) -> Self {
        Self { task, process: ProcessMark::new() }
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
            let task = tokio::spawn(pending::<()>());
            let mut owner = AbortOnDrop::new(task.abort_handle());
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
