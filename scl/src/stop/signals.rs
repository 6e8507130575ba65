//! The thread that watches for SIGTERM and SIGINT.
//!
//! It is a separate thread, because the program's threads may be computing or blocked.

use super::state::StopState;
use crate::service;
use std::io::{self, Write};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};
use tokio::signal::unix::{Signal, SignalKind, signal};
use tokio::time::Instant;
use tracing::subscriber::NoSubscriber;

/// Signals that arrive this soon after the first belong to the same request: `timeout` signals its program and then the
/// program's group, and wrappers pass on a Ctrl-C that the program has already received from the terminal.
pub const ONE_REQUEST: Duration = Duration::from_millis(500);
/// How long the flush after a stop request may take. A program that handles the request itself has this time on top of
/// its grace period.
pub(crate) const LAST_FLUSH: Duration = Duration::from_millis(500);
/// Maximum time for writing a log line before exiting: standard error may be a full pipe.
const LOG_WRITE: Duration = Duration::from_millis(100);

/// A signal that requests the stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum StopSignal {
    /// SIGINT: Ctrl-C.
    Interrupt,
    /// SIGTERM.
    Terminate,
}

impl StopSignal {
    /// Returns the exit code of a program that this signal has ended, as a shell reports it.
    pub(super) fn exit_code(self) -> u8 {
        match self {
            Self::Interrupt => 128 + 2,
            Self::Terminate => 128 + 15,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Interrupt => "SIGINT",
            Self::Terminate => "SIGTERM",
        }
    }
}

/// Starts the thread. When this returns, the signals no longer end the program by themselves.
pub(super) fn start(stop: &'static StopState, grace_period: Duration) -> io::Result<()> {
    let (started, start) = mpsc::sync_channel(1);
    thread::Builder::new().name("scl-signals".to_owned()).spawn(move || {
        let code = run(stop, grace_period, |result| {
            let _received = started.send(result);
        });
        if let Some(code) = code {
            std::process::exit(code.into());
        }
    })?;
    start.recv().unwrap_or_else(|_| Err(io::Error::other("the thread that watches for signals has panicked")))
}

fn run(stop: &StopState, grace_period: Duration, started: impl FnOnce(io::Result<()>)) -> Option<u8> {
    let runtime = Builder::new_current_thread().enable_all().build();
    let listening = runtime.and_then(|runtime| Ok((Signals::listen(&runtime)?, runtime)));
    match listening {
        Ok((mut signals, runtime)) => {
            started(Ok(()));
            let next = async || {
                let signal = signals.next().await;
                service::stopping();
                signal
            };
            Some(runtime.block_on(watch(stop, grace_period, next, log)))
        }
        Err(error) => {
            started(Err(error));
            None
        }
    }
}

/// Requests the stop on the first signal. Returns the exit code when the process has to be ended: on a second signal
/// that is a separate request, or when the grace period is over.
async fn watch(
    stop: &StopState,
    grace_period: Duration,
    mut next: impl AsyncFnMut() -> StopSignal,
    log: impl FnOnce(String),
) -> u8 {
    let first = next().await;
    let requested = Instant::now();
    stop.request(first.exit_code());
    let mut second = async || {
        loop {
            let signal = next().await;
            if requested.elapsed() >= ONE_REQUEST {
                return signal;
            }
        }
    };
    if let Ok(second) = tokio::time::timeout(grace_period, second()).await {
        return second.exit_code();
    }
    let (name, code) = (first.name(), first.exit_code());
    // Log before the grace period ends, so that the program does not exit before the line is written.
    log(format!("the program is still running {grace_period:?} after {name}; exiting with code {code}"));
    if stop.is_handled() {
        stop.end_grace_period();
        let second = tokio::time::timeout(LAST_FLUSH, second()).await;
        return second.map_or(code, StopSignal::exit_code);
    }
    code
}

fn log(line: String) {
    let (written, wait) = mpsc::sync_channel(1);
    let writer = thread::Builder::new().spawn(move || {
        if tracing::dispatcher::get_default(|log| log.is::<NoSubscriber>()) {
            // Without a subscriber, write to stderr, so that the program is not ended silently.
            let _nobody_reads = writeln!(io::stderr(), "{line}");
        } else {
            tracing::error!("{line}");
        }
        let _gave_up_waiting = written.send(());
    });
    if writer.is_ok() {
        // Fails if the line cannot be written in time; exiting matters more.
        let _timeout = wait.recv_timeout(LOG_WRITE);
    }
}

struct Signals {
    terminate: Signal,
    interrupt: Signal,
}

impl Signals {
    fn listen(runtime: &Runtime) -> io::Result<Self> {
        let _entered = runtime.enter();
        Ok(Self { terminate: signal(SignalKind::terminate())?, interrupt: signal(SignalKind::interrupt())? })
    }

    async fn next(&mut self) -> StopSignal {
        tokio::select! {
            _ = self.terminate.recv() => StopSignal::Terminate,
            _ = self.interrupt.recv() => StopSignal::Interrupt,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::StopSignal::{Interrupt, Terminate};
    use super::*;
    use std::cell::Cell;
    use std::future::pending;
    use tokio::time::sleep_until;

    const GRACE_PERIOD: Duration = Duration::from_secs(3);

    /// What one run of [`watch`] did, and how long it took after the first signal.
    struct Watched {
        code: u8,
        logged: Option<String>,
        lasted: Duration,
        stop: StopState,
    }

    /// Watches signals that arrive at the given times, in a program that may handle the request itself.
    async fn watched(signals: &[(u64, StopSignal)], handled: bool) -> Watched {
        let stop = StopState::new();
        if handled {
            stop.handle();
        }
        let (start, mut arrived, logged) = (Instant::now(), 0, Cell::new(None));
        let next = async || match signals.get(arrived) {
            Some((millis, signal)) => {
                sleep_until(start + Duration::from_millis(*millis)).await;
                arrived += 1;
                *signal
            }
            None => pending().await,
        };
        let code = watch(&stop, GRACE_PERIOD, next, |line| logged.set(Some(line))).await;
        Watched { code, logged: logged.take(), lasted: start.elapsed(), stop }
    }

    #[tokio::test(start_paused = true)]
    async fn a_second_signal_ends_the_program_with_its_number() {
        for (first, second, code) in
            [(Interrupt, Interrupt, 130), (Terminate, Interrupt, 130), (Interrupt, Terminate, 143)]
        {
            for handled in [false, true] {
                let watched = watched(&[(10, first), (510, second)], handled).await;
                assert_eq!((watched.code, watched.logged, watched.lasted.as_millis()), (code, None, 510));
                assert_eq!(watched.stop.gates_stopped(), !handled);
            }
        }
    }

    #[tokio::test(start_paused = true)]
    async fn signals_that_follow_at_once_are_part_of_the_first_request() {
        for handled in [false, true] {
            let arriving = [(10, Terminate), (10, Terminate), (11, Interrupt), (509, Interrupt)];
            let watched = watched(&arriving, handled).await;
            assert_eq!(watched.code, 143, "the grace period has ended it");
            let flush = if handled { LAST_FLUSH } else { Duration::ZERO };
            assert_eq!(watched.lasted, Duration::from_millis(10) + GRACE_PERIOD + flush);
        }
    }

    #[tokio::test(start_paused = true)]
    async fn a_program_that_does_not_end_is_ended_after_the_grace_period() {
        for (first, code, name) in [(Interrupt, 130, "SIGINT"), (Terminate, 143, "SIGTERM")] {
            let watched = watched(&[(0, first)], false).await;
            let line = format!("the program is still running 3s after {name}; exiting with code {code}");
            assert_eq!((watched.code, watched.logged, watched.lasted), (code, Some(line), GRACE_PERIOD));
            assert_eq!(watched.stop.overdue_code(), None);
        }
    }

    #[tokio::test(start_paused = true)]
    async fn a_program_that_handles_the_request_has_time_to_flush_after_its_grace_period() {
        let watched = watched(&[(0, Terminate)], true).await;
        assert_eq!((watched.code, watched.lasted), (143, GRACE_PERIOD + Duration::from_millis(500)));
        assert!(watched.logged.is_some());
        assert!(watched.stop.gates_stopped());
        assert_eq!(watched.stop.overdue_code(), Some(143));
    }

    #[tokio::test(start_paused = true)]
    async fn a_second_signal_ends_the_last_flush() {
        let watched = watched(&[(0, Terminate), (3100, Interrupt)], true).await;
        assert_eq!((watched.code, watched.lasted.as_millis()), (130, 3100));
    }
}
