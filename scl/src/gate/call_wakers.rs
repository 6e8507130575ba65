//! The waker under which a `req` gate does I/O, while any number of its calls are in progress.
//!
//! A call that is alone reads its reply itself, without a detour. While there are several, the gate's background task
//! reads and hands each its reply, because none of them may rely on another one to be polled.

use crate::state::WakeCall;
use crate::sync::{keep_waker, lock};
use crate::time::Watchdog;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::task::{Wake, Waker};

pub(super) struct CallWakers {
    wakers: Mutex<Wakers>,
    /// Number of calls in progress, which is read more often than the wakers.
    in_progress: AtomicUsize,
}

struct Wakers {
    /// The calls in progress, each with its waker if it waits.
    calls: Vec<(u64, Option<Waker>)>,
    /// Timers that no call in progress uses.
    watchdogs: Vec<Watchdog>,
    task: Option<Waker>,
}

impl CallWakers {
    /// Creates the wakers for as many calls as there are watchdogs.
    pub(super) fn new(watchdogs: Vec<Watchdog>) -> Self {
        let calls = Vec::with_capacity(watchdogs.len());
        Self { wakers: Mutex::new(Wakers { calls, watchdogs, task: None }), in_progress: AtomicUsize::new(0) }
    }

    /// Begins a call, and returns its timer, which [`end`](Self::end) takes back.
    pub(super) fn begin(&self, call: u64) -> Option<Watchdog> {
        let mut wakers = lock(&self.wakers);
        wakers.calls.push((call, None));
        self.in_progress.store(wakers.calls.len(), Ordering::Release);
        wakers.watchdogs.pop()
    }

    /// Registers the waker of a call that waits. Call this after polling the end, while its lock is still held.
    pub(super) fn wait(&self, call: u64, waker: &Waker) {
        let mut wakers = lock(&self.wakers);
        let Some((_, known)) = wakers.calls.iter_mut().find(|(id, _)| *id == call) else { return };
        keep_waker(known, waker);
    }

    /// Wakes a call whose result another call or the task has received.
    pub(super) fn wake_one(&self, call: u64) {
        let waker = lock(&self.wakers).calls.iter_mut().find(|(id, _)| *id == call).and_then(|(_, waker)| waker.take());
        waker.into_iter().for_each(Waker::wake);
    }

    pub(super) fn end(&self, call: u64, watchdog: Option<Watchdog>) {
        let mut wakers = lock(&self.wakers);
        wakers.calls.retain(|(id, _)| *id != call);
        self.in_progress.store(wakers.calls.len(), Ordering::Release);
        wakers.watchdogs.extend(watchdog);
    }

    pub(super) fn in_progress(&self) -> usize {
        self.in_progress.load(Ordering::Acquire)
    }

    pub(super) fn set_task(&self, task: &Waker) {
        keep_waker(&mut lock(&self.wakers).task, task);
    }
}

impl WakeCall for CallWakers {
    fn wake_call(&self) {
        let waiting: Vec<Waker> = lock(&self.wakers).calls.iter_mut().filter_map(|(_, waker)| waker.take()).collect();
        waiting.into_iter().for_each(Waker::wake);
    }

    fn waits(&self, futures: bool) -> bool {
        futures && lock(&self.wakers).calls.iter().any(|(_, waker)| waker.is_some())
    }
}

impl Wake for CallWakers {
    fn wake(self: Arc<Self>) {
        self.wake_by_ref();
    }

    fn wake_by_ref(self: &Arc<Self>) {
        let waker = {
            let mut wakers = lock(&self.wakers);
            let alone = match &mut wakers.calls[..] {
                [(_, waker)] => waker.take(),
                _ => None,
            };
            alone.or_else(|| wakers.task.clone())
        };
        waker.into_iter().for_each(Waker::wake);
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
    fn an_event_wakes_the_only_call_or_else_the_task() {
        let counts: [Arc<Count>; 3] = std::array::from_fn(|_| Arc::default());
        let [first, second, task] = counts.clone().map(Waker::from);
        let wakes = || counts.each_ref().map(|count| count.0.load(Ordering::SeqCst));
        let calls = Arc::new(CallWakers::new(Vec::new()));
        calls.set_task(&task);
        calls.wake_by_ref();
        assert_eq!(wakes(), [0, 0, 1], "no call");
        assert!(calls.begin(1).is_none());
        calls.wait(1, &first);
        calls.wake_by_ref();
        assert_eq!(wakes(), [1, 0, 1], "one call that waits");
        calls.wake_by_ref();
        assert_eq!(wakes(), [1, 0, 2], "a call that was woken and not polled yet");
        calls.wait(1, &first);
        assert!(calls.begin(2).is_none());
        calls.wait(2, &second);
        calls.wake_by_ref();
        assert_eq!(wakes(), [1, 0, 3], "two calls");
        calls.wake_one(2);
        assert_eq!(wakes(), [1, 1, 3], "a reply for one of them");
        calls.end(2, None);
        calls.wake_by_ref();
        assert_eq!(wakes(), [2, 1, 3], "one is left");
        calls.wait(1, &first);
        calls.wake_call();
        assert_eq!(wakes(), [3, 1, 3], "all calls end");
    }
}
