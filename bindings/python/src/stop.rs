//! The stop request of SIGTERM.
//!
//! The package watches for the signal with Python's own `signal`, because SIGINT belongs to Python and a program may have
//! handlers of its own. The rules are those of the crate `scl`: calls end at once, unless the program handles the request
//! itself; then they work until its grace period is over.

use crate::failure::Failure;
use pyo3::prelude::*;
use rustix::process::{Signal, getpid, kill_process};
use scl::host::{self, StopSignal};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

static HANDLED: AtomicBool = AtomicBool::new(false);

/// How long the flush after a stop request may take, on top of the grace period, for a program that handles the request.
const LAST_FLUSH: Duration = Duration::from_millis(500);
/// How long the last log line may take to be written.
const LOG_WRITE: Duration = Duration::from_millis(100);

/// Requests the stop, and ends a program that still runs after the grace period. SIGTERM must have its default handler
/// again.
#[pyfunction]
pub(crate) fn stop_request() -> PyResult<()> {
    let grace_period = host::grace_period().map_err(Failure::from)?;
    host::request_stop(StopSignal::Terminate);
    // No thread of Python: a handler of signals may run while Python starts one, under the same lock.
    let watching = std::thread::Builder::new().name("scl-stop".to_owned()).spawn(move || {
        std::thread::sleep(grace_period);
        end_overdue_program(grace_period);
    });
    Ok(watching.map(drop)?)
}

fn end_overdue_program(grace_period: Duration) {
    tracing::error!("the program is still running {grace_period:?} after SIGTERM; ending it");
    std::thread::sleep(LOG_WRITE);
    host::end_grace_period();
    if HANDLED.load(Ordering::Acquire) {
        std::thread::sleep(LAST_FLUSH);
    }
    // Not `exit`, which runs destructors beside a running interpreter.
    let _ended = kill_process(getpid(), Signal::TERM);
}

/// Says that the program handles stop requests itself.
#[pyfunction]
pub(crate) fn stop_handle() {
    HANDLED.store(true, Ordering::Release);
    host::handle_stop();
}

/// Returns true if a stop was requested.
#[pyfunction]
pub(crate) fn stop_requested() -> bool {
    host::is_stop_requested()
}

/// How long a program may run after a stop request, in seconds. Fails if `SCL_STOP_WITHIN` is no duration.
#[pyfunction]
pub(crate) fn stop_within() -> PyResult<f64> {
    Ok(host::grace_period().map_err(Failure::from)?.as_secs_f64())
}
