//! The one waker under which a gate's ends do I/O.
//!
//! Two parties poll them: the calls of the program, and the gate's background task, which reconnects, answers
//! heartbeats and takes messages in while the program is busy elsewhere. An event wakes the call that waits, so that a
//! message reaches it without a detour, or else the task.

use crate::state::WakeCall;
use crate::sync::{keep_waker, lock};
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Wake, Waker};

#[derive(Default)]
pub(crate) struct IoWaker {
    wakers: Mutex<Wakers>,
    /// Whether there was an event since [`Drained`] asked last.
    has_event: AtomicBool,
}

#[derive(Default)]
struct Wakers {
    call: Option<Waker>,
    /// Whether the call may vanish without [`IoWaker::cancel`]: the task is then woken too.
    may_vanish: bool,
    task: Option<Waker>,
}

impl IoWaker {
    /// Registers the waker of the call that waits. Call this after polling the ends, while their lock is still held.
    pub(crate) fn wait(&self, call: &Waker, may_vanish: bool) {
        let mut wakers = lock(&self.wakers);
        wakers.may_vanish = may_vanish;
        keep_waker(&mut wakers.call, call);
    }

    /// Unregisters a call that gave up. If an event was reported to it, the task handles that instead.
    pub(crate) fn cancel(&self) {
        let mut wakers = lock(&self.wakers);
        if wakers.call.take().is_none()
            && let Some(task) = &wakers.task
        {
            task.wake_by_ref();
        }
    }

    /// Returns a call that waits until `poll` is ready. Dropping it before that hands the I/O back to the background
    /// task.
    pub(super) fn call<R, P: FnMut(&mut Context<'_>) -> Poll<R> + Unpin>(&self, poll: P) -> Call<'_, P> {
        Call { io: self, poll, is_waiting: false }
    }

    pub(crate) fn set_task(&self, task: &Waker) {
        keep_waker(&mut lock(&self.wakers).task, task);
    }
}

impl WakeCall for IoWaker {
    fn wake_call(&self) {
        let call = lock(&self.wakers).call.take();
        call.into_iter().for_each(Waker::wake);
    }

    fn waits(&self, futures: bool) -> bool {
        futures && lock(&self.wakers).call.is_some()
    }
}

impl Wake for IoWaker {
    fn wake(self: Arc<Self>) {
        self.wake_by_ref();
    }

    fn wake_by_ref(self: &Arc<Self>) {
        self.has_event.store(true, Ordering::Release);
        let (call, task) = {
            let mut wakers = lock(&self.wakers);
            let call = wakers.call.take();
            let task = if call.is_none() || wakers.may_vanish { wakers.task.clone() } else { None };
            (call, task)
        };
        call.into_iter().chain(task).for_each(Waker::wake);
    }
}

pub(super) struct Call<'a, P> {
    io: &'a IoWaker,
    poll: P,
    is_waiting: bool,
}

impl<R, P: FnMut(&mut Context<'_>) -> Poll<R> + Unpin> Future for Call<'_, P> {
    type Output = R;

    fn poll(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<R> {
        let polled = (self.poll)(cx);
        self.is_waiting = polled.is_pending();
        polled
    }
}

impl<P> Drop for Call<'_, P> {
    fn drop(&mut self) {
        if self.is_waiting {
            self.io.cancel();
        }
    }
}

/// Whether all ends that are polled under an [`IoWaker`] had nothing when they were last polled. Then they need not be
/// polled again before an event: polling them costs as much as a short message.
pub(super) struct Drained {
    io: Arc<IoWaker>,
    /// Set and not reset.
    is_set: bool,
}

impl Drained {
    pub(super) fn new(io: Arc<IoWaker>) -> Self {
        Self { io, is_set: false }
    }

    /// Returns true if there was no event since [`set`](Self::set).
    pub(super) fn still_holds(&mut self) -> bool {
        self.is_set = self.is_set && !self.take_event();
        self.is_set
    }

    /// Call this when all ends were polled since `still_holds` and none had anything, or when the queue is full, so
    /// that nothing can be taken from them.
    pub(super) fn set(&mut self) {
        self.is_set = true;
    }

    /// Call this when an end may have something without an event.
    pub(super) fn reset(&mut self) {
        self.is_set = false;
    }

    fn take_event(&self) -> bool {
        let has_event = &self.io.has_event;
        has_event.load(Ordering::Relaxed) && has_event.swap(false, Ordering::AcqRel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[derive(Default)]
    struct Count(AtomicUsize);

    impl Wake for Count {
        fn wake(self: Arc<Self>) {
            self.0.fetch_add(1, Ordering::SeqCst);
        }
    }

    #[test]
    fn an_event_wakes_the_call_that_waits_or_else_the_task() {
        let (call, task) = (Arc::new(Count::default()), Arc::new(Count::default()));
        let (call_waker, task_waker) = (Waker::from(Arc::clone(&call)), Waker::from(Arc::clone(&task)));
        let wakes = || (call.0.load(Ordering::SeqCst), task.0.load(Ordering::SeqCst));
        let io = Arc::new(IoWaker::default());
        io.set_task(&task_waker);
        io.wait(&call_waker, false);
        io.wake_by_ref();
        assert_eq!(wakes(), (1, 0), "a waiting call");
        io.wake_by_ref();
        assert_eq!(wakes(), (1, 1), "nobody waits any more");
        io.wait(&call_waker, true);
        io.wake_by_ref();
        assert_eq!(wakes(), (2, 2), "a call that may vanish");
        io.wait(&call_waker, false);
        io.cancel();
        assert_eq!(wakes(), (2, 2), "cancelled before an event");
        io.wait(&call_waker, false);
        io.wake_by_ref();
        io.cancel();
        assert_eq!(wakes(), (3, 3), "cancelled after an event that nobody handled");
    }

    #[test]
    fn what_is_drained_stays_so_until_an_event() {
        let io = Arc::new(IoWaker::default());
        let mut drained = Drained::new(Arc::clone(&io));
        assert!(!drained.still_holds(), "not polled yet");
        drained.set();
        assert!(drained.still_holds() && drained.still_holds(), "nothing has happened");
        io.wake_by_ref();
        assert!(!drained.still_holds() && !drained.still_holds(), "an event");
        io.wake_by_ref();
        drained.set();
        assert!(!drained.still_holds(), "an event while the ends were polled");
        drained.set();
        drained.reset();
        assert!(!drained.still_holds(), "reset");
    }
}
