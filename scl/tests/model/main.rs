//! Connections put through random sequences of steps: ends appear, stall, vanish and return in every order, and after
//! each step everything must be as a small model says.
//!
//! | file | what it knows |
//! |---|---|
//! | `flow` | what is sent: gates of `pub`, `sub`, `push`, `pull` beside their model |
//! | `call` | what is asked: gates of `req` and `rep` beside theirs |
//! | `raised` | a waker that tells whether it was used |
//! | `trial` | running cases, and printing the shortest sequence that fails |
//!
//! The cases are the same in every run; `PROPTEST_RNG_SEED` gives others, `PROPTEST_CASES` more of them.
#![allow(clippy::unwrap_used)]

mod call;
mod flow;
mod raised;
mod trial;

use scl::place::RuntimeDir;
use scl::transport::zeromq::{Medium, ZeroMq};
use tempfile::TempDir;

/// The transport of real sockets, in a folder of its own.
fn sockets() -> (ZeroMq, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let runtime_dir = RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into()));
    (ZeroMq::new(runtime_dir.unwrap().system("model").unwrap(), Medium::Ipc), folder)
}
