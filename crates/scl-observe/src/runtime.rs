//! What runs the asynchronous part of a command, and the signals that stop it.

use scl_terminal::Problem;
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

/// SIGINT, SIGTERM and SIGHUP: they end every command that goes on until it is stopped.
#[derive(Debug)]
pub struct StopSignals([Signal; 3]);

impl StopSignals {
    /// From now on, the signals no longer end the process. Must be called inside a tokio runtime.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn watch() -> Result<Self, Problem> {
        Ok(Self([
            watch_signal(SignalKind::interrupt())?,
            watch_signal(SignalKind::terminate())?,
            watch_signal(SignalKind::hangup())?,
        ]))
    }

    /// Waits for one of the signals.
    pub async fn received(&mut self) {
        let [interrupt, terminate, hangup] = &mut self.0;
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
            _ = hangup.recv() => {}
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
