//! Plays `viewer` of `fresh.yaml` for a service manager: `watched MODE TASK`.
//!
//! | MODE | the program |
//! |---|---|
//! | `async` | has `#[scl::main]` and is async |
//! | `blocking` | has `#[scl::main]` and is not async |
//! | `threads` | is async, with a main function and a runtime of several threads of its own |
//!
//! | TASK | what it does |
//! |---|---|
//! | `wait` | waits for a message that never comes |
//! | `hang` | waits for a message for a moment, then computes forever |
//! | `pace` | calls its gate once in 200 ms and says so, and sleeps in between |
//! | `idle` | never calls its gate |

use scl_tests::say;
use std::process::ExitCode;
use std::time::Duration;

scl::topology!("topologies/fresh.yaml", only = [viewer]);

const PACE: Duration = Duration::from_millis(200);

fn main() -> ExitCode {
    match std::env::args().nth(1).as_deref() {
        Some("async") => asynchronous::main(),
        Some("threads") => threads(),
        _ => blocking::main(),
    }
}

fn task() -> String {
    std::env::args().nth(2).unwrap_or_default()
}

mod asynchronous {
    use crate::{Viewer, play};

    #[scl::main]
    pub(crate) async fn main(viewer: Viewer) -> scl::Result<()> {
        play(viewer).await
    }
}

#[tokio::main(flavor = "multi_thread", worker_threads = 2)]
async fn threads() -> ExitCode {
    scl::host::notify_service_manager();
    // On a worker, so that no thread is special.
    let played = tokio::spawn(async { play(Viewer::open().await?).await });
    if matches!(played.await, Ok(Ok(()))) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

async fn play(mut viewer: Viewer) -> scl::Result<()> {
    say("open");
    match task().as_str() {
        "wait" => drop(viewer.newest.recv().await?),
        "hang" => {
            let _nothing = tokio::time::timeout(PACE, viewer.newest.recv()).await;
            compute();
        }
        "pace" => loop {
            viewer.newest.try_recv()?;
            say("called");
            tokio::time::sleep(PACE).await;
        },
        _ => std::future::pending().await,
    }
    Ok(())
}

mod blocking {
    use crate::{PACE, Viewer, compute, task};
    use scl_tests::say;

    #[scl::main]
    pub(crate) fn main(mut viewer: Viewer) -> scl::Result<()> {
        say("open");
        match task().as_str() {
            "wait" => drop(viewer.newest.recv_blocking()?),
            "hang" => {
                let _nothing = viewer.newest.recv_timeout(PACE);
                compute();
            }
            "pace" => loop {
                viewer.newest.try_recv()?;
                say("called");
                std::thread::sleep(PACE);
            },
            _ => loop {
                std::thread::park();
            },
        }
        Ok(())
    }
}

fn compute() -> ! {
    say("computing");
    loop {
        std::hint::spin_loop();
    }
}
