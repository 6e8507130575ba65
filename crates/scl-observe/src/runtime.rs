//! The runtime for the asynchronous part of a command, and the signals that stop it.

use crate::process::has_bit;
use scl_terminal::Problem;
use std::fs;
use std::future::pending;
use tokio::runtime::Builder;
use tokio::signal::unix::{Signal, SignalKind, signal};

/// Runs the asynchronous part of a command on this thread.
///
/// # Errors
/// That of `command`, or the operating system refuses what the runtime needs.
pub fn block_on<T>(command: impl Future<Output = Result<T, Problem>>) -> Result<T, Problem> {
    let runtime = Builder::new_current_thread().enable_all().build();
    runtime.map_err(|error| Problem::new(format!("cannot start: {error}")))?.block_on(command)
}

/// SIGINT, SIGTERM and SIGHUP, which end every command that runs until it is stopped. SIGHUP is ignored if the command
/// was started by `nohup`.
#[derive(Debug)]
pub struct StopSignals {
    hangup: Option<Signal>,
    interrupt: Signal,
    terminate: Signal,
}

impl StopSignals {
    /// Watches for the signals, which no longer end the process from now on. Must be called inside a tokio runtime.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn watch() -> Result<Self, Problem> {
        // `nohup` starts programs with SIGHUP ignored; keep it that way.
        let hangup = SignalKind::hangup();
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let is_ignored = has_bit(&status, "SigIgn:", hangup.as_raw_value().unsigned_abs() - 1);
        Ok(Self {
            hangup: if is_ignored { None } else { Some(watch_signal(hangup)?) },
            interrupt: watch_signal(SignalKind::interrupt())?,
            terminate: watch_signal(SignalKind::terminate())?,
        })
    }

    /// Waits for one of the signals.
    pub async fn received(&mut self) {
        let Self { hangup, interrupt, terminate } = self;
        let hangup = async {
            match hangup {
                Some(hangup) => hangup.recv().await,
                None => pending().await,
            }
        };
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
            _ = hangup => {}
        }
    }
}

/// Watches for one signal.
///
/// # Errors
/// The operating system refuses.
pub fn watch_signal(kind: SignalKind) -> Result<Signal, Problem> {
    signal(kind).map_err(|error| Problem::new(format!("cannot watch for signals: {error}")))
}
