//! The progress of a stop request: requested, handled by the program, overdue.

use crate::sync::lock;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use tokio::sync::Notify;

const REQUESTED: u8 = 1;
const HANDLED: u8 = 2;
const OVERDUE: u8 = 4;

/// A stop request: whether it was made, and who acts on it.
#[derive(Debug)]
pub(crate) struct StopState {
    /// All flags in one atomic, so that each gate call reads only that.
    flags: AtomicU8,
    /// The exit code of a program that is still running after its grace period.
    overdue_code: AtomicU8,
    changed: Notify,
    blocked: Mutex<()>,
    unblock: Condvar,
}

impl StopState {
    pub(super) const fn new() -> Self {
        Self {
            flags: AtomicU8::new(0),
            overdue_code: AtomicU8::new(0),
            changed: Notify::const_new(),
            blocked: Mutex::new(()),
            unblock: Condvar::new(),
        }
    }

    /// Requests the stop. Gates stop unless the program handles the request itself.
    pub(super) fn request(&self, overdue_code: u8) {
        self.overdue_code.store(overdue_code, Ordering::Release);
        self.set(REQUESTED);
    }

    /// Makes the program handle the request itself: its gates work until the grace period is over.
    pub(super) fn handle(&self) {
        // Programs may call this in a loop, so write only once.
        if !self.has(HANDLED) {
            self.flags.fetch_or(HANDLED, Ordering::AcqRel);
        }
    }

    /// Ends the grace period: gates stop even if the program handles the request itself.
    pub(super) fn end_grace_period(&self) {
        self.set(OVERDUE);
    }

    pub(super) fn is_requested(&self) -> bool {
        self.has(REQUESTED)
    }

    pub(super) fn is_handled(&self) -> bool {
        self.has(HANDLED)
    }

    /// Returns the exit code, if the grace period is over.
    pub(crate) fn overdue_code(&self) -> Option<u8> {
        self.has(OVERDUE).then(|| self.overdue_code.load(Ordering::Acquire))
    }

    pub(super) fn gates_stopped(&self) -> bool {
        let flags = self.flags.load(Ordering::Acquire);
        flags & OVERDUE != 0 || flags & (REQUESTED | HANDLED) == REQUESTED
    }

    /// Waits until [`is_requested`](Self::is_requested) returns true.
    pub(crate) async fn requested(&self) {
        self.wait_until(Self::is_requested).await;
    }

    /// Waits until [`gates_stopped`](Self::gates_stopped) returns true.
    pub(crate) async fn until_gates_stopped(&self) {
        self.wait_until(Self::gates_stopped).await;
    }

    /// [`requested`](Self::requested) for a plain thread.
    pub(super) fn wait_requested_blocking(&self) {
        let blocked = lock(&self.blocked);
        let waited = self.unblock.wait_while(blocked, |()| !self.is_requested());
        drop(waited.unwrap_or_else(PoisonError::into_inner));
    }

    async fn wait_until(&self, condition: impl Fn(&Self) -> bool) {
        loop {
            // Created before the check, so it also sees a change right after it.
            let changed = self.changed.notified();
            if condition(self) {
                return;
            }
            changed.await;
        }
    }

    fn has(&self, flag: u8) -> bool {
        self.flags.load(Ordering::Acquire) & flag != 0
    }

    fn set(&self, flag: u8) {
        self.flags.fetch_or(flag, Ordering::AcqRel);
        self.changed.notify_waiters();
        // Locked, so that no thread is between its check and its wait.
        let _blocked = lock(&self.blocked);
        self.unblock.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Step = fn(&StopState);

    #[test]
    fn gates_stop_unless_the_program_handles_the_request_in_its_grace_period() {
        let request: Step = |stop| stop.request(143);
        let handle: Step = StopState::handle;
        let end_grace_period: Step = StopState::end_grace_period;
        let cases: [(&[Step], bool); 7] = [
            (&[], false),
            (&[handle], false),
            (&[request], true),
            (&[handle, request], false),
            // A program that handles the request in its error path gets its gates back.
            (&[request, handle], false),
            (&[handle, request, end_grace_period], true),
            (&[request, end_grace_period, handle], true),
        ];
        for (index, (steps, stopped)) in cases.into_iter().enumerate() {
            let stop = StopState::new();
            steps.iter().for_each(|step| step(&stop));
            assert_eq!(stop.gates_stopped(), stopped, "case {index}");
        }
    }

    #[tokio::test]
    async fn waiting_ends_with_the_request_or_with_the_grace_period() {
        let stop = StopState::new();
        stop.handle();
        let (requested, stopped) = (stop.requested(), stop.until_gates_stopped());
        tokio::pin!(requested, stopped);
        assert!(is_pending(requested.as_mut()) && is_pending(stopped.as_mut()));
        stop.request(143);
        requested.await;
        stop.requested().await;
        assert!(is_pending(stopped.as_mut()));
        stop.end_grace_period();
        stopped.await;
        stop.until_gates_stopped().await;
    }

    #[test]
    fn a_blocked_thread_goes_on_after_the_request() {
        let stop = StopState::new();
        std::thread::scope(|scope| {
            let (started, start) = std::sync::mpsc::channel();
            let waiting = &stop;
            scope.spawn(move || {
                started.send(rustix::thread::gettid()).unwrap();
                waiting.wait_requested_blocking();
            });
            let stat = format!("/proc/self/task/{}/stat", start.recv().unwrap());
            // Until the thread sleeps, so that the request has to wake it.
            while !std::fs::read_to_string(&stat).unwrap().contains(") S ") {}
            stop.request(143);
        });
        stop.wait_requested_blocking();
    }

    fn is_pending(future: std::pin::Pin<&mut impl Future>) -> bool {
        future.poll(&mut std::task::Context::from_waker(std::task::Waker::noop())).is_pending()
    }
}
