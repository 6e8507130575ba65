//! Gates under random sequences of steps: peers appear, stall, vanish and return in any order, and after each step
//! everything must be as a small model predicts.
//!
//! | file | contents |
//! |---|---|
//! | `flow` | messages: `pub`, `sub`, `push` and `pull` gates, and their model |
//! | `call` | requests: `req` and `rep` gates, and their model |
//! | `wake_flag` | a waker that only notes that it was used |
//! | `runner` | running cases, and printing the shortest sequence that fails |
//!
//! The cases are the same in every run; `PROPTEST_RNG_SEED` selects others, `PROPTEST_CASES` more of them.
#![allow(clippy::unwrap_used)]

mod call;
mod flow;
mod runner;
mod wake_flag;

use scl::runtime_dir::RuntimeDir;
use scl::transport::zeromq::{TransportKind, ZeroMq};
use tempfile::TempDir;

/// A transport over real sockets, in a folder of its own.
fn sockets() -> (ZeroMq, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let runtime_dir = RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into()));
    (ZeroMq::new(runtime_dir.unwrap().system("model").unwrap(), TransportKind::Ipc), folder)
}
