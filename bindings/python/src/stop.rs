//! The stop request of SIGTERM and SIGINT.
//!
//! The package watches for the signals with Python's own `signal`, because a program may have handlers of its own. The
//! rules are those of the crate `scl`: calls end at once, unless the program handles the request itself; then they work
//! until its grace period is over.

use crate::failure::Failure;
use pyo3::prelude::*;
use rustix::process::{Signal, getpid, kill_process};
use scl::host::{self, ONE_REQUEST, StopSignal};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

static HANDLED: AtomicBool = AtomicBool::new(false);

/// How long the flush after a stop request may take, on top of the grace period, for a program that handles the
/// request.
const LAST_FLUSH: Duration = Duration::from_millis(500);
/// How long the last log line may take to be written.
const LOG_WRITE: Duration = Duration::from_millis(100);

/// Requests the stop, and ends a program that still runs after the grace period or receives another signal after
/// [`ONE_REQUEST`]. `watched` are the signals whose handlers in Python call this. Further calls do nothing.
#[pyfunction]
pub(crate) fn stop_request(number: i32, watched: Vec<i32>) -> PyResult<()> {
    if host::is_stop_requested() {
        return Ok(());
    }
    let (signal, stop_signal) = if number == Signal::INT.as_raw() {
        (Signal::INT, StopSignal::Interrupt)
    } else {
        (Signal::TERM, StopSignal::Terminate)
    };
    host::request_stop(stop_signal);
    let grace_period = host::grace_period().map_err(Failure::from)?;
    let another_ends = Arc::new(AtomicBool::new(false));
    for number in watched {
        // Python runs its signal handlers only between bytecode instructions, which a hanging program may never reach.
        signal_hook::flag::register_conditional_default(number, Arc::clone(&another_ends))?;
    }
    // Not a Python thread: this signal handler may have interrupted Python while it was starting a thread and held the
    // lock that starting another one needs.
    let watching = std::thread::Builder::new().name("scl-stop".to_owned()).spawn(move || {
        let one_request = ONE_REQUEST.min(grace_period);
        std::thread::sleep(one_request);
        another_ends.store(true, Ordering::Release);
        std::thread::sleep(grace_period.saturating_sub(one_request));
        end_overdue_program(signal, grace_period);
    });
    Ok(watching.map(drop)?)
}

fn end_overdue_program(signal: Signal, grace_period: Duration) {
    let name = if signal == Signal::INT { "SIGINT" } else { "SIGTERM" };
    tracing::error!("the program is still running {grace_period:?} after {name}; ending it");
    std::thread::sleep(LOG_WRITE);
    host::end_grace_period();
    if HANDLED.load(Ordering::Acquire) {
        std::thread::sleep(LAST_FLUSH);
    }
    // Not `exit`, which would run destructors while the interpreter is still running.
    let _ended = kill_process(getpid(), signal);
}

/// Declares that the program handles stop requests itself.
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

/// Returns how long a program may run after a stop request, in seconds. Fails if `SCL_STOP_WITHIN` is not a duration.
#[pyfunction]
pub(crate) fn stop_within() -> PyResult<f64> {
    Ok(host::grace_period().map_err(Failure::from)?.as_secs_f64())
}
