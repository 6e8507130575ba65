//! The one waker under which a gate's ends do I/O.
//!
//! Two parties poll them: the calls of the program, and the gate's background task, which reconnects, answers heartbeats
//! and takes messages in while the program is busy elsewhere. An event wakes the call that waits, so that a message
//! reaches it without a detour, or else the task.

use crate::state::WakeCall;
use crate::sync::lock;
use std::sync::{Arc, Mutex};
use std::task::{Wake, Waker};

#[derive(Default)]
pub(crate) struct IoWaker {
    wakers: Mutex<Wakers>,
}

#[derive(Default)]
struct Wakers {
    call: Option<Waker>,
    /// Whether the call may vanish without [`IoWaker::cancel`]: the task is then woken too.
    may_vanish: bool,
    task: Option<Waker>,
}

impl IoWaker {
    /// Registers the call that waits. To be used under the lock of what it waits for, after it was polled.
    pub(crate) fn wait(&self, call: &Waker, may_vanish: bool) {
        let mut wakers = lock(&self.wakers);
        wakers.may_vanish = may_vanish;
        match &wakers.call {
            Some(known) if known.will_wake(call) => {}
            _ => wakers.call = Some(call.clone()),
        }
    }

    /// The call gave up. If an event was reported to it, the task handles that instead.
    pub(crate) fn cancel(&self) {
        let mut wakers = lock(&self.wakers);
        if wakers.call.take().is_none()
            && let Some(task) = &wakers.task
        {
            task.wake_by_ref();
        }
    }

    pub(crate) fn set_task(&self, task: &Waker) {
        let mut wakers = lock(&self.wakers);
        match &wakers.task {
            Some(known) if known.will_wake(task) => {}
            _ => wakers.task = Some(task.clone()),
        }
    }
}

impl WakeCall for IoWaker {
    fn wake_call(&self) {
        let call = lock(&self.wakers).call.take();
        if let Some(call) = call {
            call.wake();
        }
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
        let (call, task) = {
            let mut wakers = lock(&self.wakers);
            let call = wakers.call.take();
            let task = if call.is_none() || wakers.may_vanish { wakers.task.clone() } else { None };
            (call, task)
        };
        call.into_iter().chain(task).for_each(Waker::wake);
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
}
