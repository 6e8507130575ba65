//! An end with a separate waker, which is called again only after it has used that waker.

use crate::sync::lock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Wake, Waker};

/// An end and its waker.
pub(super) struct Watched<E> {
    pub(super) end: E,
    signal: Arc<Signal>,
    pub(super) waker: Waker,
}

#[derive(Default)]
struct Signal {
    woken: AtomicBool,
    wakes: AtomicUsize,
    /// Wakes the task of the test.
    test: Mutex<Option<Waker>>,
}

impl Wake for Signal {
    fn wake(self: Arc<Self>) {
        self.wakes.fetch_add(1, Ordering::SeqCst);
        self.woken.store(true, Ordering::SeqCst);
        let test = lock(&self.test).clone();
        if let Some(test) = test {
            test.wake();
        }
    }
}

impl<E> Watched<E> {
    pub(super) fn new(end: E) -> Self {
        let signal = Arc::new(Signal { woken: AtomicBool::new(true), ..Signal::default() });
        Self { end, waker: Arc::clone(&signal).into(), signal }
    }

    /// Replaces the waker, as happens when another task takes over.
    pub(super) fn renew_waker(&mut self) {
        let signal = Arc::new(Signal { woken: AtomicBool::new(true), ..Signal::default() });
        self.waker = Arc::clone(&signal).into();
        self.signal = signal;
    }

    /// Makes the next call without a waker, whether the end was woken or not.
    pub(super) fn use_no_waker(&mut self) {
        self.waker = Waker::noop().clone();
        self.call_again();
    }

    pub(super) fn wakes(&self) -> usize {
        self.signal.wakes.load(Ordering::SeqCst)
    }

    /// Makes the next [`take_turn`](Self::take_turn) return true.
    pub(super) fn call_again(&self) {
        self.signal.woken.store(true, Ordering::SeqCst);
    }

    /// Returns true if the end is to be called: at first, after it was woken, and after it returned something.
    pub(super) fn take_turn(&self, test: &Context<'_>) -> bool {
        *lock(&self.signal.test) = Some(test.waker().clone());
        self.signal.woken.swap(false, Ordering::SeqCst)
    }

    pub(super) fn poll_with<R>(
        &mut self,
        test: &Context<'_>,
        poll: impl FnOnce(&mut E, &mut Context<'_>) -> Poll<R>,
    ) -> Poll<R> {
        if !self.take_turn(test) {
            return Poll::Pending;
        }
        let polled = poll(&mut self.end, &mut Context::from_waker(&self.waker));
        if polled.is_ready() {
            self.call_again();
        }
        polled
    }
}
