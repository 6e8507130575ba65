//! How many links of a sender are alive.

use crate::sync::{keep_waker, lock};
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

    #[cfg_attr(not(feature = "zeromq"), expect(dead_code, reason = "only that transport has to be woken"))]
    pub(super) fn wake_on_drop(&self, cx: &Context<'_>) {
        keep_waker(&mut lock(&self.waker), cx.waker());
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
