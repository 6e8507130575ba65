//! How many links of a sender are alive.

use crate::sync::lock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::task::{Context, Waker};

/// Held by a link; tells its [`Sender`](crate::transport::Sender) that it has been dropped.
pub(super) struct LinkAlive(Arc<LinkCount>);

/// Counts the links that are alive.
#[derive(Default)]
pub(super) struct LinkCount {
    alive: AtomicUsize,
    /// Woken when a link is dropped.
    waker: Mutex<Option<Waker>>,
}

impl LinkCount {
    pub(super) fn new_link(self: &Arc<Self>) -> LinkAlive {
        self.alive.fetch_add(1, Ordering::AcqRel);
        LinkAlive(Arc::clone(self))
    }

    pub(super) fn count(&self) -> usize {
        self.alive.load(Ordering::Acquire)
    }

    pub(super) fn wake_on_drop(&self, cx: &Context<'_>) {
        let mut waker = lock(&self.waker);
        if !waker.as_ref().is_some_and(|known| known.will_wake(cx.waker())) {
            *waker = Some(cx.waker().clone());
        }
    }
}

impl Drop for LinkAlive {
    fn drop(&mut self) {
        self.0.alive.fetch_sub(1, Ordering::AcqRel);
        if let Some(waker) = lock(&self.0.waker).take() {
            waker.wake();
        }
    }
}
