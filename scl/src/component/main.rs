//! What `#[scl::main]` does around a program: the component, the runtime, the signals, the log, the exit code.

use super::{Component, OpenOptions, realtime};
use crate::error::{BlockingError, Error};
use std::future::poll_fn;
use std::pin::pin;
use std::process::ExitCode;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::Poll;
use std::time::Duration;
use tokio::runtime::Builder;
use tokio::signal::unix::{SignalKind, signal};
use tokio::sync::Notify;

/// How long a program that ends waits for connected peers to take what is left.
const LINGER: Duration = Duration::from_secs(1);

/// What a main function may return.
pub trait Outcome {
    #[doc(hidden)]
    fn into_result(self) -> Result<(), Error>;
}

impl Outcome for () {
    fn into_result(self) -> Result<(), Error> {
        Ok(())
    }
}

impl<E: Into<Error>> Outcome for Result<(), E> {
    fn into_result(self) -> Result<(), Error> {
        self.map_err(Into::into)
    }
}

/// Runs an async main function on a current-thread runtime, the fastest for gates, until it ends or SIGTERM or SIGINT
/// comes.
pub fn run_async<C: Component, F, R>(main: fn(C) -> F) -> ExitCode
where
    F: Future<Output = R>,
    R: Outcome,
{
    set_up_log();
    // Before any thread is started, so that all have it.
    let honoured = realtime::honour_environment().map_err(Error::from);
    let runtime = honoured.and_then(|()| Builder::new_current_thread().enable_all().build().map_err(Error::from));
    exit_code(runtime.and_then(|runtime| {
        runtime.block_on(async {
            let component = super::open::<C>(OpenOptions::new()).await?;
            let core = component.gates().first().map(|gate| std::sync::Arc::clone(gate.core()));
            let result = {
                let mut stop = pin!(stop_signal());
                let mut main = pin!(main(component));
                poll_fn(|cx| match main.as_mut().poll(cx) {
                    Poll::Ready(outcome) => Poll::Ready(outcome.into_result()),
                    Poll::Pending => stop.as_mut().poll(cx).map_err(Error::from),
                })
                .await
            };
            if let Some(core) = core
                && let Err(error) = core.flush(LINGER).await
            {
                tracing::warn!("{error}");
            }
            result
        })
    }))
}

/// Runs a main function without async; a signal ends its blocking calls with [`BlockingError::Stopped`], which counts
/// as a clean end.
pub fn run_blocking<C: Component, R: Outcome>(main: fn(C) -> R) -> ExitCode {
    set_up_log();
    let honoured = realtime::honour_environment().map_err(Error::from);
    let result = honoured.and_then(|()| watch_signals().map_err(Error::from)).and_then(|()| {
        let component = super::open_blocking::<C>(OpenOptions::new())?;
        let core = component.gates().first().map(|gate| std::sync::Arc::clone(gate.core()));
        let result = main(component).into_result();
        if let Some(core) = core
            && let Err(error) = core.flush_blocking(LINGER)
        {
            tracing::warn!("{error}");
        }
        result
    });
    exit_code(result)
}

/// Waits for a future, but not longer than until the program is told to stop.
pub(super) async fn until_stopped<F: Future>(future: F) -> Result<F::Output, BlockingError> {
    let stop = stop();
    if stop.is_none() {
        return Ok(future.await);
    }
    let mut future = pin!(future);
    let mut told = pin!(async {
        if let Some(stop) = stop {
            stop.wait().await;
        }
    });
    poll_fn(|cx| match future.as_mut().poll(cx) {
        Poll::Ready(ready) => Poll::Ready(Ok(ready)),
        Poll::Pending => told.as_mut().poll(cx).map(|()| Err(BlockingError::Stopped)),
    })
    .await
}

/// Set once a signal told a program without async to stop; there only after [`watch_signals`].
static STOP: OnceLock<Stop> = OnceLock::new();

fn stop() -> Option<&'static Stop> {
    STOP.get()
}

#[derive(Debug, Default)]
struct Stop {
    told: AtomicBool,
    changed: Notify,
}

impl Stop {
    async fn wait(&self) {
        loop {
            let changed = self.changed.notified();
            if self.told.load(Ordering::SeqCst) {
                return;
            }
            changed.await;
        }
    }
}

/// Watches for signals in a thread, because the program's own thread may be anywhere. A second one ends the program.
fn watch_signals() -> std::io::Result<()> {
    let runtime = Builder::new_current_thread().enable_io().build()?;
    let signals = runtime.block_on(async { Signals::listen() })?;
    STOP.get_or_init(Stop::default);
    std::thread::Builder::new().name("scl-signals".to_owned()).spawn(move || {
        runtime.block_on(async move {
            let mut signals = signals;
            signals.next().await;
            if let Some(stop) = stop() {
                stop.told.store(true, Ordering::SeqCst);
                stop.changed.notify_waiters();
            }
            signals.next().await;
            std::process::exit(130);
        })
    })?;
    Ok(())
}

async fn stop_signal() -> std::io::Result<()> {
    Signals::listen()?.next().await;
    Ok(())
}

struct Signals {
    terminate: tokio::signal::unix::Signal,
    interrupt: tokio::signal::unix::Signal,
}

impl Signals {
    fn listen() -> std::io::Result<Self> {
        Ok(Self { terminate: signal(SignalKind::terminate())?, interrupt: signal(SignalKind::interrupt())? })
    }

    async fn next(&mut self) {
        tokio::select! {
            _ = self.terminate.recv() => {}
            _ = self.interrupt.recv() => {}
        }
    }
}

/// Writes the log to standard error unless the program has set up its own; `SCL_LOG` says how much.
fn set_up_log() {
    let level = std::env::var("SCL_LOG").ok().and_then(|level| level.parse().ok()).unwrap_or(tracing::Level::WARN);
    let log = tracing_subscriber::fmt().with_writer(std::io::stderr).with_max_level(level).with_target(false);
    // A program that has a log of its own keeps it.
    let _already_set = log.without_time().try_init();
}

fn exit_code(result: Result<(), Error>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.is_stop() => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:?}");
            ExitCode::FAILURE
        }
    }
}
