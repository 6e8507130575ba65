//! For bindings to other languages: what [`main`](macro@crate::main) does around a Rust program, piece by piece.
//!
//! A program whose main function is not Rust's needs signals and a log as any other component does, but its language
//! may handle signals in its own way. A binding either lets SCL watch for them, with [`watch_signals`], or reports the
//! signals that it receives, with [`request_stop`]. Either way a stop request ends the waiting calls of all gates with
//! [`BlockingError::Stopped`](crate::BlockingError::Stopped).
//!
//! ```no_run
//! # fn open() -> scl::Result<()> {
//! scl::host::start_log()?;
//! scl::host::watch_signals()?;
//! # Ok(())
//! # }
//! ```

mod error_kind;

use crate::component::RealTimeSettings;
use crate::environment;
use crate::error::{OpenError, Result};
use crate::sync::lock;
use crate::{log, service, stderr_log, stop};
use std::sync::Mutex;
use std::time::Duration;

pub use crate::causes::text_with_causes;
pub use crate::state::prepare_thread;
pub use crate::stop::{
    ONE_REQUEST, StopSignal, end_grace_period, gates_stopped, handle as handle_stop, request as request_stop,
    was_requested as is_stop_requested,
};
pub use error_kind::ErrorKind;

/// Writes the log to standard error, as detailed as `SCL_LOG` says, unless the process has a log already.
///
/// # Errors
/// [`OpenError::Environment`] if `SCL_LOG` is not a level.
pub fn start_log() -> Result<(), OpenError> {
    stderr_log::start(log::level(&environment::of_process)?);
    Ok(())
}

/// Starts reporting to the service manager that has started the process, such as systemd or `scl run`: when the
/// components that are opened are ready, that a stop was requested, and that the program is alive, as `docs/service.md`
/// describes. Does nothing without a service manager, and when called again.
pub fn notify_service_manager() {
    service::start(&environment::of_process);
}

/// Sends the service manager, if one has started the process, a notification that `sd_notify(3)` describes, such as
/// `READY=1` and a line break. For programs without components; for others, [`notify_service_manager`] does it. Returns
/// at once: if the manager does not read, the notification is lost, which is logged.
pub fn tell_service_manager(text: &str) {
    service::tell(&environment::of_process, text);
}

/// From now on SIGTERM and SIGINT request a stop instead of ending the process. The process is ended if it is still
/// running after the [`grace_period`], or when a second signal arrives after [`ONE_REQUEST`]. Further calls do nothing.
///
/// # Errors
/// `SCL_STOP_WITHIN` is not a duration, or the operating system provides no thread or no file descriptor.
pub fn watch_signals() -> Result<()> {
    Ok(stop::watch_signals(grace_period()?)?)
}

/// Applies the real-time settings `SCL_SCHED` and `SCL_CPU` to the calling thread and to those that it starts from now
/// on, and logs a warning for anything that the operating system refuses. Call it after [`watch_signals`], whose thread
/// must be able to run while a thread with these settings computes. Further calls do nothing.
///
/// # Errors
/// [`OpenError::Environment`] if a setting is not understood.
pub fn apply_real_time() -> Result<(), OpenError> {
    static APPLIED: Mutex<bool> = Mutex::new(false);
    let mut applied = lock(&APPLIED);
    if !*applied {
        RealTimeSettings::read(&environment::of_process)?.apply();
        *applied = true;
    }
    Ok(())
}

/// Returns how long a program may take to end after a stop request: `SCL_STOP_WITHIN`, or 3 s.
///
/// # Errors
/// [`OpenError::Environment`] if the value is not a duration of 1 us to a day.
pub fn grace_period() -> Result<Duration, OpenError> {
    stop::grace_period(&environment::of_process)
}
