//! Plays `leaver` of `exits.yaml`: does one thing and ends at once, `leaver RUNTIME ENDING TASK`.
//!
//! | argument | values |
//! |---|---|
//! | RUNTIME | `current_thread`, `multi_thread`, `blocking`, `main`, `main_blocking` |
//! | ENDING | `close`, `drop`, `drop_after_runtime`; `thread_local_close` and `thread_local_drop` leave it to the end of the thread |
//! | TASK | `send COUNT` publishes and pushes; `publish COUNT` publishes; `ready COUNT` waits for all peers before it sends; `reply` answers one request; `panic` panics |

mod with_main;

use scl::{BlockingError, SendError};
use scl_tests::say;
use std::cell::RefCell;
use std::process::ExitCode;
use std::time::Duration;
use test::Number;
use tokio::runtime::Builder;

scl::topology!("topologies/exits.yaml", only = [leaver]);

const READY: Duration = Duration::from_secs(300);

fn main() -> ExitCode {
    let result = match argument(1).as_str() {
        "current_thread" => run_async(Builder::new_current_thread()),
        "multi_thread" => run_async(Builder::new_multi_thread()),
        "blocking" => run_blocking(),
        "main" => return with_main::asynchronous::main(),
        _ => return with_main::blocking::main(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:?}");
            ExitCode::FAILURE
        }
    }
}

fn run_async(mut builder: Builder) -> scl::Result<()> {
    let runtime = builder.worker_threads(2).enable_all().build()?;
    let left_open = runtime.block_on(perform_and_end())?;
    drop(runtime);
    drop(left_open);
    Ok(())
}

/// Returns the component if it is to be dropped later.
async fn perform_and_end() -> scl::Result<Option<Leaver>> {
    let leaver = perform(Leaver::open().await?).await?;
    match argument(2).as_str() {
        "close" => leaver.close(close_timeout()).await?,
        "drop" => drop(leaver),
        _ => return Ok(Some(leaver)),
    }
    Ok(None)
}

fn run_blocking() -> scl::Result<()> {
    if argument(3) == "ready" {
        // Made before the thread-local values that the component needs, so destroyed after them.
        OF_THREAD.with_borrow(|_| ());
    }
    let leaver = perform_blocking(Leaver::open_blocking()?)?;
    match argument(2).as_str() {
        "close" => leaver.close_blocking(close_timeout())?,
        "thread_local_close" | "thread_local_drop" => OF_THREAD.with_borrow_mut(|kept| kept.0 = Some(leaver)),
        _ => drop(leaver),
    }
    Ok(())
}

thread_local! {
    static OF_THREAD: RefCell<Kept> = const { RefCell::new(Kept(None)) };
}

/// Ends the component when the thread ends.
struct Kept(Option<Leaver>);

impl Drop for Kept {
    fn drop(&mut self) {
        let Some(mut leaver) = self.0.take() else { return };
        if argument(3) == "ready" {
            let refused = leaver.values.send_blocking(&Number::default());
            let is_refused = matches!(&refused, Err(SendError::Blocking { source: BlockingError::ThreadEnding, .. }));
            // A panic would end the program here, too.
            assert!(is_refused, "{refused:?}");
        }
        // Without peers, messages are left.
        if argument(2) == "thread_local_close"
            && let Err(error) = leaver.close_blocking(close_timeout())
        {
            eprintln!("error: {error:?}");
        }
    }
}

async fn perform(mut leaver: Leaver) -> scl::Result<Leaver> {
    match argument(3).as_str() {
        "reply" => {
            let request = leaver.answer.recv().await?;
            let reply = doubled(&request);
            request.reply(&reply)?;
        }
        "panic" => panic!("on purpose"),
        task => {
            if task == "ready" {
                leaver.ready(READY).await?;
            }
            for message in messages() {
                leaver.values.send(&message).await?;
                if task != "publish" {
                    leaver.jobs.send(&message).await?;
                }
            }
        }
    }
    say("leaving");
    Ok(leaver)
}

fn perform_blocking(mut leaver: Leaver) -> scl::Result<Leaver> {
    match argument(3).as_str() {
        "reply" => {
            let request = leaver.answer.recv_blocking()?;
            let reply = doubled(&request);
            request.reply(&reply)?;
        }
        "panic" => panic!("on purpose"),
        task => {
            if task == "ready" {
                leaver.ready_blocking(READY)?;
            }
            for message in messages() {
                leaver.values.send_blocking(&message)?;
                if task != "publish" {
                    leaver.jobs.send_blocking(&message)?;
                }
            }
        }
    }
    say("leaving");
    Ok(leaver)
}

fn messages() -> impl Iterator<Item = Number> {
    let count: u64 = argument(4).parse().unwrap_or_default();
    (0..count).map(|value| Number { value, padding: Vec::new() })
}

fn doubled(request: &Number) -> Number {
    Number { value: request.value * 2, padding: Vec::new() }
}

/// `CLOSE_TIMEOUT` in milliseconds, or longer than any test takes.
fn close_timeout() -> Duration {
    let chosen = std::env::var("CLOSE_TIMEOUT").ok().and_then(|text| text.parse().ok());
    Duration::from_millis(chosen.unwrap_or(300_000))
}

fn argument(index: usize) -> String {
    std::env::args().nth(index).unwrap_or_default()
}
