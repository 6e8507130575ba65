//! The gate behind a Python object: one call at a time uses it, and others may look at it meanwhile.

use crate::failure::Failure;
use crate::process::drop_detached;
use scl::untyped::Gate;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// A gate that calls claim, and that is locked only while SCL runs: not while a call looks for signals, and not by a
/// thread that the end of the interpreter has stopped.
pub(crate) struct Claimed {
    claimed: AtomicBool,
    /// Number of threads that want to look at the gate while a call waits.
    visitors: AtomicUsize,
    /// `None` once the component is closed.
    gate: Mutex<Option<Gate>>,
}

/// A call that uses the gate. No other does until it is dropped.
pub(crate) struct Claim<'g>(&'g Claimed);

impl Claimed {
    pub(crate) fn new(gate: Gate) -> Self {
        Self { claimed: AtomicBool::new(false), visitors: AtomicUsize::new(0), gate: Mutex::new(Some(gate)) }
    }

    /// `None` if another thread's call uses the gate.
    pub(crate) fn claim(&self) -> Option<Claim<'_>> {
        (!self.claimed.swap(true, Ordering::Acquire)).then_some(Claim(self))
    }

    /// Looks at the gate, between two steps of a call that waits. It may take some time.
    pub(crate) fn visit<R>(&self, look: impl FnOnce(&Gate) -> R) -> Option<R> {
        self.as_visitor(|gate| gate.as_ref().map(look))
    }

    /// Drops the gate; the call that waits fails at its next step.
    pub(crate) fn close(&self) {
        drop(self.as_visitor(Option::take));
    }

    fn as_visitor<R>(&self, act: impl FnOnce(&mut Option<Gate>) -> R) -> R {
        self.visitors.fetch_add(1, Ordering::AcqRel);
        let result = act(&mut self.gate.lock().unwrap_or_else(PoisonError::into_inner));
        self.visitors.fetch_sub(1, Ordering::AcqRel);
        result
    }
}

/// Its component may end with it, and then hands over what is left.
impl Drop for Claimed {
    fn drop(&mut self) {
        drop_detached(self.gate.get_mut().unwrap_or_else(PoisonError::into_inner).take());
    }
}

impl Claim<'_> {
    /// Runs one step of a call; `None` if the component is closed.
    pub(crate) fn step<R>(&mut self, step: impl FnOnce(&mut Gate) -> Result<R, Failure>) -> Option<Result<R, Failure>> {
        let gate = &mut *self.0.gate.lock().unwrap_or_else(PoisonError::into_inner);
        gate.as_mut().map(step)
    }

    /// As [`step`](Self::step), after visitors had their turn: locks are not fair.
    pub(crate) fn next_step<R>(
        &mut self,
        step: impl FnOnce(&mut Gate) -> Result<R, Failure>,
    ) -> Option<Result<R, Failure>> {
        while self.0.visitors.load(Ordering::Acquire) > 0 {
            std::thread::sleep(Duration::from_micros(100));
        }
        self.step(step)
    }
}

impl Drop for Claim<'_> {
    fn drop(&mut self) {
        self.0.claimed.store(false, Ordering::Release);
    }
}
