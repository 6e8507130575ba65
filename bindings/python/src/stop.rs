//! The stop request of SIGTERM.
//!
//! The package watches for the signal with Python's own `signal`, because SIGINT belongs to Python and a program may have
//! handlers of its own. The rules are those of the crate `scl`: calls end at once, unless the program handles the request
//! itself; then they work until its grace period is over.

use crate::failure::Failure;
use pyo3::prelude::*;
use scl::host::{self, StopSignal};
use std::sync::atomic::{AtomicBool, Ordering};

static HANDLED: AtomicBool = AtomicBool::new(false);

/// Requests the stop.
#[pyfunction]
pub(crate) fn stop_request() {
    host::request_stop(StopSignal::Terminate);
}

/// Says that the program handles stop requests itself.
#[pyfunction]
pub(crate) fn stop_handle() {
    HANDLED.store(true, Ordering::Release);
    host::handle_stop();
}

/// Ends the grace period. Returns whether the program handles stop requests itself.
#[pyfunction]
pub(crate) fn stop_overdue() -> bool {
    host::end_grace_period();
    HANDLED.load(Ordering::Acquire)
}

/// Returns true if a stop was requested.
#[pyfunction]
pub(crate) fn stop_requested() -> bool {
    host::is_stop_requested()
}

/// How long a program may take to end after a stop request, in seconds.
#[pyfunction]
pub(crate) fn stop_grace_period() -> PyResult<f64> {
    Ok(host::grace_period().map_err(Failure::from)?.as_secs_f64())
}
