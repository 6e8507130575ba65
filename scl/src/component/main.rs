//! What `#[scl::main]` does around a program: settings, log, signals, the component, the flush at the end, the exit
//! code.

use super::{Component, Flush, RealTimeSettings};
use crate::environment;
use crate::error::{Error, NotFlushed};
use crate::options::OpenOptions;
use crate::{log, service, stderr_log, stop};
use std::io::Write;
use std::panic::{self, AssertUnwindSafe};
use std::process::ExitCode;
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};

/// How long a program that ends by itself waits for its peers to receive what was sent.
const LINGER: Duration = Duration::from_secs(1);

/// Runs an async main function on a current-thread runtime, the fastest for gates, until it returns or a stop request
/// ends it at its next `.await`.
pub fn run_async<C: Component, F: Future<Output = Result<(), Error>>>(main: fn(C) -> F) -> ExitCode {
    let result = set_up().and_then(|()| {
        let runtime = Builder::new_current_thread().enable_all().build()?;
        run(runtime, async {
            let component = super::open::<C>(OpenOptions::new()).await?;
            let handle = C::handle(&component).clone();
            let returned = stop::until_stopped(main(component)).await;
            let result = returned.map_err(Error::from).and_then(|result| result);
            let (mode, timeout) = last_flush();
            stderr_log::end_events(timeout);
            conclude(result, handle.0.flush(mode, timeout).await)
        })
    });
    exit_code(result)
}

/// Runs a main function without async. After a stop request its calls to gates fail with
/// [`BlockingError::Stopped`](crate::BlockingError::Stopped), which counts as success.
pub fn run_blocking<C: Component>(main: fn(C) -> Result<(), Error>) -> ExitCode {
    let result = set_up().and_then(|()| {
        let component = super::open_blocking::<C>(OpenOptions::new())?;
        let handle = C::handle(&component).clone();
        let result = main(component);
        let (mode, timeout) = last_flush();
        stderr_log::end_events(timeout);
        conclude(result, handle.0.flush_blocking(mode, timeout))
    });
    exit_code(result)
}

/// Reads the settings of the environment and applies them.
fn set_up() -> Result<(), Error> {
    let variables = &environment::of_process;
    let level = log::level(variables)?;
    let grace_period = stop::grace_period(variables)?;
    let settings = RealTimeSettings::read(variables)?;
    stderr_log::start(level);
    service::start(variables);
    // Start the signal thread before the real-time settings, which it would inherit: a main thread that computes at
    // real-time priority would then keep it from running on their shared processor.
    stop::watch_signals(grace_period)?;
    settings.apply();
    Ok(())
}

/// Runs a future and ends the runtime.
fn run<F: Future>(runtime: Runtime, future: F) -> F::Output {
    let result = panic::catch_unwind(AssertUnwindSafe(|| runtime.block_on(future)));
    if result.is_err() || stop::was_requested() {
        // Dropping the runtime would wait for blocking tasks, for example one that reads standard input.
        runtime.shutdown_background();
    }
    result.unwrap_or_else(|payload| panic::resume_unwind(payload))
}

/// Returns which peers the end of `main` waits for, and for how long: after a stop request only for connected ones,
/// because all programs are stopping.
fn last_flush() -> (Flush, Duration) {
    if stop::was_requested() { (Flush::Connected, stop::LAST_FLUSH) } else { (Flush::Running, LINGER) }
}

/// The result of the program: an error of `main`, or else a failed flush unless the program was asked to stop.
fn conclude(result: Result<(), Error>, flushed: Result<(), NotFlushed>) -> Result<(), Error> {
    match (result, flushed) {
        (Ok(()), Err(error)) if error.is_failure() && !stop::was_requested() => Err(error.into()),
        (result, flushed) => {
            if let Err(error) = flushed {
                tracing::warn!("{error}");
            }
            result
        }
    }
}

fn exit_code(result: Result<(), Error>) -> ExitCode {
    let code = match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.is_stop() => ExitCode::SUCCESS,
        Err(error) => {
            // Unlike `eprintln`, no panic if standard error is closed.
            drop(writeln!(std::io::stderr(), "error: {error:?}"));
            ExitCode::FAILURE
        }
    };
    stop::STOP.overdue_code().map_or(code, ExitCode::from)
}
