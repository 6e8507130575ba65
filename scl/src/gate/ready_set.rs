//! A file descriptor that is readable while one of several gates has something, for event loops.
//!
//! All reasons to be readable are kept under one lock, together with the state of the descriptor, so the two always
//! agree: no change can fall between looking at the reasons and clearing the descriptor.

use crate::state::WakeCall;
use crate::sync::lock;
use rustix::event::{EventfdFlags, eventfd};
use std::io;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::{Arc, Mutex, Weak};
use std::task::Wake;

pub(crate) struct ReadySet {
    descriptor: OwnedFd,
    reasons: Mutex<Reasons>,
}

/// Why the descriptor is readable.
#[derive(Default)]
struct Reasons {
    /// Number of gates that have something.
    gates: usize,
    /// Whether a waker was woken and that was not acknowledged.
    woken: bool,
    stop_requested: bool,
    stop_acknowledged: bool,
    /// Whether the descriptor is readable.
    raised: bool,
}

impl ReadySet {
    pub(crate) fn new() -> io::Result<Arc<Self>> {
        let descriptor = eventfd(0, EventfdFlags::CLOEXEC | EventfdFlags::NONBLOCK)?;
        Ok(Arc::new(Self { descriptor, reasons: Mutex::default() }))
    }

    pub(crate) fn descriptor(&self) -> BorrowedFd<'_> {
        self.descriptor.as_fd()
    }

    pub(crate) fn set_woken(&self, woken: bool) {
        self.change(|reasons| reasons.woken = woken);
    }

    pub(crate) fn request_stop(&self) {
        self.change(|reasons| reasons.stop_requested = true);
    }

    /// May be called before the request was noticed here.
    pub(crate) fn acknowledge_stop(&self) {
        self.change(|reasons| reasons.stop_acknowledged = true);
    }

    fn change(&self, change: impl FnOnce(&mut Reasons)) {
        let mut reasons = lock(&self.reasons);
        change(&mut reasons);
        let raise = reasons.gates > 0 || reasons.woken || (reasons.stop_requested && !reasons.stop_acknowledged);
        if std::mem::replace(&mut reasons.raised, raise) == raise {
            return;
        }
        // Neither can fail: the counter is 0 before the write, and 1 before the read.
        let _done = match raise {
            true => rustix::io::write(&self.descriptor, &1_u64.to_ne_bytes()),
            false => rustix::io::read(&self.descriptor, &mut [0; 8]),
        };
    }
}

impl Wake for ReadySet {
    fn wake(self: Arc<Self>) {
        self.set_woken(true);
    }

    fn wake_by_ref(self: &Arc<Self>) {
        self.set_woken(true);
    }
}

/// Ended calls are a reason to poll them.
impl WakeCall for ReadySet {
    fn wake_call(&self) {
        self.set_woken(true);
    }
}

/// Reports to the sets that a gate belongs to whether it has something.
#[derive(Default)]
pub(crate) struct ReadySignals {
    sets: Vec<Weak<ReadySet>>,
    /// What was reported last.
    ready: bool,
}

impl ReadySignals {
    /// Returns true if nobody wants to know.
    pub(crate) fn is_empty(&self) -> bool {
        self.sets.is_empty()
    }

    pub(crate) fn add(&mut self, set: Weak<ReadySet>) {
        if self.ready {
            set.upgrade().into_iter().for_each(|set| set.change(|reasons| reasons.gates += 1));
        }
        self.sets.push(set);
    }

    pub(crate) fn report(&mut self, ready: bool) {
        if self.sets.is_empty() || std::mem::replace(&mut self.ready, ready) == ready {
            return;
        }
        self.sets.retain(|set| {
            let Some(set) = set.upgrade() else { return false };
            set.change(|reasons| if ready { reasons.gates += 1 } else { reasons.gates -= 1 });
            true
        });
    }
}

/// A gate that is gone has nothing.
impl Drop for ReadySignals {
    fn drop(&mut self) {
        self.report(false);
    }
}
