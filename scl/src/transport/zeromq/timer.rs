//! A point in time to wait for, with a runtime or without.

use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::time::{Instant, Sleep};

/// Wakes the task at a time that was set. Uses the runtime's timer only while the task waits for it.
pub(super) struct Timer {
    runtime: Option<Handle>,
    deadline: Option<Instant>,
    sleep: Option<Pin<Box<Sleep>>>,
}

/// To be created inside the runtime. Without one, the time passes, but no task is woken.
impl Default for Timer {
    fn default() -> Self {
        Self { runtime: Handle::try_current().ok(), deadline: None, sleep: None }
    }
}

impl Timer {
    pub(super) fn detach(&mut self) {
        self.runtime = None;
        self.sleep = None;
    }

    pub(super) fn set(&mut self, within: Duration) {
        self.set_at(Instant::now() + within);
    }

    pub(super) fn set_at(&mut self, deadline: Instant) {
        self.deadline = Some(deadline);
        if let Some(sleep) = &mut self.sleep
            && sleep.deadline() != deadline
        {
            sleep.as_mut().reset(deadline);
        }
    }

    /// Like [`clear`](Self::clear), but keeps the memory for the next time. The task may be woken once more.
    pub(super) fn unset(&mut self) {
        self.deadline = None;
    }

    pub(super) fn clear(&mut self) {
        self.deadline = None;
        self.sleep = None;
    }

    pub(super) fn is_set(&self) -> bool {
        self.deadline.is_some()
    }

    /// Ready when the time has come, or if none was set. The timer is no longer set then.
    pub(super) fn poll(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let Some(deadline) = self.deadline else { return Poll::Ready(()) };
        if Instant::now() < deadline {
            let Some(runtime) = &self.runtime else { return Poll::Pending };
            let sleep = self.sleep.get_or_insert_with(|| {
                let _inside = runtime.enter();
                Box::pin(tokio::time::sleep_until(deadline))
            });
            ready!(sleep.as_mut().poll(cx));
        }
        self.clear();
        Poll::Ready(())
    }
}
