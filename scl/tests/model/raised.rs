//! A waker that tells whether it was used.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Wake, Waker};

/// Raised when its waker is woken.
#[derive(Default, Clone)]
pub(crate) struct Raised(Arc<Flag>);

#[derive(Default)]
struct Flag(AtomicBool);

impl Wake for Flag {
    fn wake(self: Arc<Self>) {
        self.0.store(true, Ordering::SeqCst);
    }
}

impl Raised {
    /// Raised from the start.
    pub(crate) fn up() -> Self {
        Self(Arc::new(Flag(AtomicBool::new(true))))
    }

    pub(crate) fn waker(&self) -> Waker {
        Arc::clone(&self.0).into()
    }

    pub(crate) fn is_raised(&self) -> bool {
        self.0.0.load(Ordering::SeqCst)
    }
}
