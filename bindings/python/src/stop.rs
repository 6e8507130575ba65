//! The stop request of SIGTERM.
//!
//! The package watches for the signal with Python's own `signal`, because SIGINT belongs to Python and a program may have
//! handlers of its own. The rules are those of the crate `scl`: calls end at once, unless the program handles the request
//! itself; then they work until its grace period is over.

use pyo3::prelude::*;
use std::sync::atomic::{AtomicU8, Ordering};

const REQUESTED: u8 = 1;
const HANDLED: u8 = 2;
const OVERDUE: u8 = 4;

static FLAGS: AtomicU8 = AtomicU8::new(0);

/// Requests the stop.
#[pyfunction]
pub(crate) fn stop_request() {
    FLAGS.fetch_or(REQUESTED, Ordering::SeqCst);
}

/// Says that the program handles stop requests itself.
#[pyfunction]
pub(crate) fn stop_handle() {
    FLAGS.fetch_or(HANDLED, Ordering::SeqCst);
}

/// Ends the grace period. Returns whether the program handles stop requests itself.
#[pyfunction]
pub(crate) fn stop_overdue() -> bool {
    FLAGS.fetch_or(OVERDUE, Ordering::SeqCst) & HANDLED != 0
}

/// Returns true if a stop was requested.
#[pyfunction]
pub(crate) fn stop_requested() -> bool {
    FLAGS.load(Ordering::SeqCst) & REQUESTED != 0
}

/// Returns true if no gate may be used any more.
pub(crate) fn gates_stopped() -> bool {
    let flags = FLAGS.load(Ordering::Relaxed);
    flags & OVERDUE != 0 || flags & (REQUESTED | HANDLED) == REQUESTED
}
