//! Stop requests: SIGTERM and SIGINT, and what a program does about them.
//!
//! The first signal requests a stop. Unless the program handles the request itself, its gates stop at once, so that the
//! next call to any of them ends the program. A program that is still running after the grace period is ended, as is
//! one that receives a second signal after [`ONE_REQUEST`].

mod signals;
mod state;

use crate::environment::{self, Variables};
use crate::error::{BlockingError, OpenError};
use crate::service;
use crate::sync::lock;
pub(crate) use signals::LAST_FLUSH;
pub use signals::{ONE_REQUEST, StopSignal};
use state::StopState;
use std::future::poll_fn;
use std::io;
use std::pin::pin;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::Poll;
use std::time::Duration;

/// The grace period if `SCL_STOP_WITHIN` is not set.
const GRACE_PERIOD: Duration = Duration::from_secs(3);

pub(crate) static STOP: StopState = StopState::new();
/// Whether the thread that watches for signals runs.
static WATCHING: AtomicBool = AtomicBool::new(false);

/// Waits until the program is asked to stop by SIGTERM or SIGINT.
///
/// By default a stop request ends a program that [`main`](macro@crate::main) runs at its next call to any gate. Once
/// the program has called this function, [`stop_requested_blocking`] or [`is_stop_requested`], it handles stop requests
/// itself: its gates keep working after the request, and it has the time given by `SCL_STOP_WITHIN` (default `3s`) to
/// return from `main`. After that it is ended with exit code 128 + the number of the signal; a second signal, half a
/// second after the first or later, ends it at once.
///
/// Programs without [`main`](macro@crate::main) can use these functions, too: the first call starts to watch for the
/// signals, which from then on do not end the program by themselves.
///
/// ```no_run
/// scl::topology!("doc/rover.yaml");
///
/// #[scl::main]
/// async fn main(mut ui: UserInterface) -> scl::Result<()> {
///     let mut tick = scl::time::interval(std::time::Duration::from_millis(100))?;
///     let mut stop = std::pin::pin!(scl::stop_requested());
///     loop {
///         tokio::select! {
///             () = &mut stop => break,
///             ticked = tick.tick() => ticked?,
///         }
///         ui.commands.call(&rover::Command { target_speed: 1.0 }).await?;
///     }
///     ui.commands.call(&rover::Command { target_speed: 0.0 }).await?;
///     Ok(())
/// }
/// ```
///
/// The call itself counts, whether the future is polled or not.
///
/// # Panics
/// If the operating system provides no thread or no file descriptor to watch for signals. That cannot happen in a
/// program that [`main`](macro@crate::main) runs, because it already watches.
///
/// # Cancel safety
/// Cancel safe: once a stop is requested, every call returns at once.
pub fn stop_requested() -> impl Future<Output = ()> + Send + 'static {
    handle_stop();
    STOP.requested()
}

/// [`stop_requested`] for a plain thread. Do not call it in async code, which it would block.
///
/// # Panics
/// Same as [`stop_requested`].
pub fn stop_requested_blocking() {
    handle_stop();
    STOP.wait_requested_blocking();
}

/// Returns true if the program has been asked to stop. The program then handles stop requests itself, as described at
/// [`stop_requested`].
///
/// ```no_run
/// scl::topology!("doc/rover.yaml");
///
/// #[scl::main]
/// fn main(mut ui: UserInterface) -> scl::Result<()> {
///     while !scl::is_stop_requested() {
///         ui.commands.call_blocking(&rover::Command { target_speed: 1.0 })?;
///     }
///     ui.commands.call_blocking(&rover::Command { target_speed: 0.0 })?;
///     Ok(())
/// }
/// ```
///
/// # Panics
/// Same as [`stop_requested`].
pub fn is_stop_requested() -> bool {
    handle_stop();
    STOP.is_requested()
}

/// Requests a stop, for a binding that watches for signals itself. Ending the process after the grace period is left to
/// the binding, too.
pub fn request(signal: StopSignal) {
    STOP.request(signal.exit_code());
    service::stopping();
}

/// Makes the program handle stop requests itself, as [`stop_requested`](crate::stop_requested) does: its gates keep
/// working after the request.
pub fn handle() {
    STOP.handle();
}

/// Ends the grace period: the gates stop working even if the program handles the stop request itself.
pub fn end_grace_period() {
    STOP.end_grace_period();
}

/// Returns true if no gate can be used any more: a stop was requested and the program does not handle it itself, or its
/// grace period is over.
pub fn gates_stopped() -> bool {
    // Must be cheap: every call to a gate checks this.
    STOP.gates_stopped()
}

/// Returns true if a stop was requested. Unlike [`is_stop_requested`](crate::is_stop_requested), this does not make the
/// program handle the request itself.
pub fn was_requested() -> bool {
    STOP.is_requested()
}

/// Waits for a future, or until [`gates_stopped`], whichever comes first.
///
/// # Errors
/// [`BlockingError::Stopped`] if the gates were stopped first.
pub(crate) async fn until_stopped<F: Future>(future: F) -> Result<F::Output, BlockingError> {
    until(&STOP, future).await
}

async fn until<F: Future>(stop: &StopState, future: F) -> Result<F::Output, BlockingError> {
    let mut future = pin!(future);
    let mut stopped = pin!(stop.until_gates_stopped());
    poll_fn(|cx| {
        // Check first: if the future is ready on every poll, `stopped` is never polled.
        if stop.gates_stopped() {
            return Poll::Ready(Err(BlockingError::Stopped));
        }
        match future.as_mut().poll(cx) {
            Poll::Ready(output) => Poll::Ready(Ok(output)),
            Poll::Pending => stopped.as_mut().poll(cx).map(|()| Err(BlockingError::Stopped)),
        }
    })
    .await
}

/// Starts to watch for SIGTERM and SIGINT, unless a thread already does.
///
/// # Errors
/// The operating system provides no thread or no file descriptor.
pub(crate) fn watch_signals(grace_period: Duration) -> io::Result<()> {
    static STARTING: Mutex<()> = Mutex::new(());
    if WATCHING.load(Ordering::Acquire) {
        return Ok(());
    }
    let _starting = lock(&STARTING);
    if !WATCHING.load(Ordering::Acquire) {
        signals::start(&STOP, grace_period)?;
        WATCHING.store(true, Ordering::Release);
    }
    Ok(())
}

/// Reads `SCL_STOP_WITHIN`.
///
/// # Errors
/// [`OpenError::Environment`] if the value is not a duration of 1 us to a day.
pub(crate) fn grace_period(variables: Variables<'_>) -> Result<Duration, OpenError> {
    let found =
        environment::read(variables, "SCL_STOP_WITHIN", "a duration such as `3s` or `500ms`", environment::duration)?;
    Ok(found.unwrap_or(GRACE_PERIOD))
}

/// Makes the program handle stop requests itself. Cheap after the first call.
fn handle_stop() {
    if STOP.is_handled() && WATCHING.load(Ordering::Acquire) {
        return;
    }
    STOP.handle();
    let grace_period = grace_period(&environment::of_process).unwrap_or_else(|error| {
        // Happens only without `#[scl::main]`, which rejects such a value.
        tracing::warn!("{error}; using {GRACE_PERIOD:?}");
        GRACE_PERIOD
    });
    if let Err(error) = watch_signals(grace_period) {
        panic!("cannot watch for signals: {error}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::refused;
    use std::future::{pending, ready};

    #[tokio::test]
    async fn a_future_runs_until_the_gates_are_stopped() {
        let stop = StopState::new();
        assert_eq!(until(&stop, ready(7)).await, Ok(7));
        let waiting = until(&stop, pending::<()>());
        let (waited, ()) = tokio::join!(waiting, async { stop.request(143) });
        assert_eq!(waited, Err(BlockingError::Stopped));
        assert_eq!(until(&stop, ready(7)).await, Err(BlockingError::Stopped));
    }

    #[tokio::test]
    async fn a_future_that_is_always_ready_ends_at_its_next_wait() {
        let stop = StopState::new();
        let mut rounds = 0;
        // As a gate does: ready until the gates are stopped, then never again.
        let publish = async || {
            if stop.gates_stopped() {
                pending().await
            }
        };
        let main = async {
            loop {
                publish().await;
                rounds += 1;
                if rounds == 1000 {
                    stop.request(143);
                }
            }
        };
        assert_eq!(until::<_>(&stop, main).await, Err::<(), _>(BlockingError::Stopped));
        assert_eq!(rounds, 1000);
    }

    #[tokio::test]
    async fn a_program_that_handles_the_request_goes_on_until_its_grace_period_is_over() {
        let stop = StopState::new();
        stop.handle();
        let main = async {
            stop.request(143);
            tokio::task::yield_now().await;
            stop.end_grace_period();
            pending::<()>().await
        };
        assert_eq!(until(&stop, main).await, Err(BlockingError::Stopped));
        assert_eq!(stop.overdue_code(), Some(143));
    }

    #[test]
    fn the_grace_period_is_read_or_refused() {
        let millis = |millis| Ok(Duration::from_millis(millis));
        let refuses = |value: &str| Err(format!("SCL_STOP_WITHIN={value}, not a duration such as `3s` or `500ms`"));
        let cases = [
            ("", millis(3000)),
            ("3s", millis(3000)),
            ("500ms", millis(500)),
            ("2000 us", millis(2)),
            ("0.5s", millis(500)),
            ("1us", Ok(Duration::from_micros(1))),
            ("3m", millis(180_000)),
            ("+3s", millis(3000)),
            ("86400s", millis(86_400_000)),
        ];
        let bad =
            ["3", "s", "3 ", "3d", "-3s", "3s ", "1e3s", "infs", "nans", "0s", "0.1us", "86401s", "1.2.3s", "many"];
        let cases = cases.into_iter().chain(bad.into_iter().map(|value| (value, refuses(value))));
        for (value, expected) in cases {
            let variables = |name: &str| (name == "SCL_STOP_WITHIN").then(|| value.into());
            assert_eq!(refused(grace_period(&variables)), expected, "{value}");
        }
    }
}
