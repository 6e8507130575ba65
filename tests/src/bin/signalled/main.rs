//! Plays `left` of `twins.yaml` with `#[scl::main]` and does one thing until it is stopped: `signalled MODE TASK` with
//! `async` or `blocking` as MODE.
//!
//! | TASK | what the program does |
//! |---|---|
//! | `send` | sends in a loop that waits for nothing |
//! | `try_send` | the same with calls that never wait |
//! | `receive`, `pull`, `call`, `serve` | waits at one gate; `call` calls again and again |
//! | `motors_off` | sends until it is asked to stop, then pushes the value 4242 and returns |
//! | `motors_off_beside` | the same, with a thread or task of its own that waits for the request |
//! | `ignore` | takes note of the request and continues |
//! | `last_words` | waits for the request, then pushes the value 4242 and returns |
//! | `ask_once` | asks for the request once, before there is one, and continues |
//! | `compute` | never makes a call to a gate again |

mod asynchronous;
mod blocking;

use scl_tests::say;
use std::process::ExitCode;
use std::time::Duration;
use test::Number;

scl::topology!("topologies/twins.yaml", only = [left]);

const READY: Duration = Duration::from_secs(300);
const MOTORS_OFF: u64 = 4242;

fn main() -> ExitCode {
    match argument(1).as_str() {
        "async" => asynchronous::main(),
        _ => blocking::main(),
    }
}

fn argument(index: usize) -> String {
    std::env::args().nth(index).unwrap_or_default()
}

fn number(value: u64) -> Number {
    Number { value, padding: Vec::new() }
}

/// Keeps the thread busy forever.
fn compute() -> ! {
    say("running");
    loop {
        std::hint::spin_loop();
    }
}
