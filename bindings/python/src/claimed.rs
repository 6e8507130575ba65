//! The gate behind a Python object: one call at a time uses it, and other threads may inspect it between the steps of
//! that call.

use scl::untyped::Gate;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// A gate that calls claim. It is locked only while code of SCL runs: not while a call checks for signals, and not by a
/// thread that the end of the interpreter has stopped.
pub(crate) struct Claimed {
    claimed: AtomicBool,
    /// Number of threads that inspect the gate, or wait to.
    visitors: AtomicUsize,
    slot: Mutex<Slot>,
}

#[allow(clippy::large_enum_variant, reason = "there is one per gate, and a box would be allocated for each call")]
enum Slot {
    Here(Gate),
    /// A call has taken the gate out and will put it back.
    Away,
    /// The component is closed.
    Closed,
}

/// Why a gate cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unusable {
    Busy,
    Closed,
}

/// The right of a call to use the gate. Until it is dropped, no other call can claim the gate.
pub(crate) struct Claim<'g>(&'g Claimed);

impl Claimed {
    pub(crate) fn new(gate: Gate) -> Self {
        let slot = Mutex::new(Slot::Here(gate));
        Self { claimed: AtomicBool::new(false), visitors: AtomicUsize::new(0), slot }
    }

    /// Claims the gate unless another call uses it.
    pub(crate) fn claim(&self) -> Result<Claim<'_>, Unusable> {
        if self.claimed.swap(true, Ordering::Acquire) { Err(Unusable::Busy) } else { Ok(Claim(self)) }
    }

    /// Inspects the gate. Waits for the end of the current step if a call uses the gate; fails if a call has taken it
    /// out.
    pub(crate) fn visit<R>(&self, look: impl FnOnce(&mut Gate) -> R) -> Result<R, Unusable> {
        self.visitors.fetch_add(1, Ordering::AcqRel);
        let looked = self.with(look);
        self.visitors.fetch_sub(1, Ordering::AcqRel);
        looked
    }

    /// Drops the gate, at once or when the call that has taken it out ends.
    pub(crate) fn close(&self) {
        self.visitors.fetch_add(1, Ordering::AcqRel);
        let gate = std::mem::replace(&mut *self.lock(), Slot::Closed);
        self.visitors.fetch_sub(1, Ordering::AcqRel);
        drop(gate);
    }

    fn with<R>(&self, act: impl FnOnce(&mut Gate) -> R) -> Result<R, Unusable> {
        match &mut *self.lock() {
            Slot::Here(gate) => Ok(act(gate)),
            Slot::Away => Err(Unusable::Busy),
            Slot::Closed => Err(Unusable::Closed),
        }
    }

    fn lock(&self) -> MutexGuard<'_, Slot> {
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<'g> Claim<'g> {
    /// Runs one step of a call.
    pub(crate) fn step<R>(&mut self, step: impl FnOnce(&mut Gate) -> R) -> Result<R, Unusable> {
        self.0.with(step)
    }

    /// Like [`step`](Self::step), but lets visitors go first, because locks are not fair.
    pub(crate) fn next_step<R>(&mut self, step: impl FnOnce(&mut Gate) -> R) -> Result<R, Unusable> {
        while self.0.visitors.load(Ordering::Acquire) > 0 {
            std::thread::sleep(Duration::from_micros(100));
        }
        self.step(step)
    }

    /// Takes the gate out until the result is dropped, for a call that needs it between its steps, too.
    pub(crate) fn borrow(self) -> Result<Borrowed<'g>, Unusable> {
        let claimed = self.0;
        let mut slot = claimed.lock();
        match std::mem::replace(&mut *slot, Slot::Away) {
            Slot::Here(gate) => Ok(Borrowed { gate: Some(gate), claim: self }),
            Slot::Away => Err(Unusable::Busy),
            Slot::Closed => {
                *slot = Slot::Closed;
                Err(Unusable::Closed)
            }
        }
    }
}

/// A gate that a call has taken out.
pub(crate) struct Borrowed<'g> {
    /// `None` once put back.
    gate: Option<Gate>,
    claim: Claim<'g>,
}

impl Borrowed<'_> {
    pub(crate) fn gate(&mut self) -> Option<&mut Gate> {
        self.gate.as_mut()
    }
}

impl Drop for Borrowed<'_> {
    fn drop(&mut self) {
        if let Some(gate) = self.gate.take() {
            let mut slot = self.claim.0.lock();
            if matches!(*slot, Slot::Away) {
                *slot = Slot::Here(gate);
            }
        }
    }
}

impl Drop for Claim<'_> {
    fn drop(&mut self) {
        self.0.claimed.store(false, Ordering::Release);
    }
}
