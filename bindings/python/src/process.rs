//! The process: whether it is a forked child, and whether its interpreter is ending.

use forkguard::atfork::Guard;
use pyo3::prelude::*;
use std::sync::OnceLock;
use std::thread::{self, ThreadId};
use std::time::Duration;

/// The thread that ends the interpreter.
static EXITING: OnceLock<ThreadId> = OnceLock::new();

/// Says that this thread is about to end the interpreter.
///
/// All other threads are daemon threads then, which Python ends where they are. A call of such a thread must not return into
/// an interpreter that is gone, nor fail because the components are being closed, so it stays where it is until the process
/// ends.
#[pyfunction]
pub(crate) fn exiting() {
    let _is_set = EXITING.set(thread::current().id());
}

/// Never returns once another thread is about to end the interpreter.
pub(crate) fn stay_if_exiting() {
    while is_ended_by_another() {
        thread::sleep(Duration::MAX);
    }
}

/// As [`stay_if_exiting`], for a thread that has the interpreter.
pub(crate) fn stay_detached_if_exiting(py: Python<'_>) {
    if is_ended_by_another() {
        py.detach(stay_if_exiting);
    }
}

fn is_ended_by_another() -> bool {
    EXITING.get().is_some_and(|ending| *ending != thread::current().id())
}

/// Drops a value that may wait for peers, without the interpreter where there is one.
pub(crate) fn drop_detached<T: Send>(value: T) {
    let mut value = Some(value);
    Python::try_attach(|py| py.detach(|| drop(value.take())));
    drop(value);
}

/// Remembers the process that created it.
#[derive(Debug, Clone)]
pub(crate) struct Origin {
    pid: u32,
    /// Counts forks without a system call, unless the C library refused to.
    forks: Option<Guard>,
}

impl Origin {
    pub(crate) fn here() -> Self {
        Self { pid: std::process::id(), forks: Guard::try_new().ok() }
    }

    /// Returns true in a child that was forked from the process that created this.
    pub(crate) fn is_elsewhere(&self) -> bool {
        match &self.forks {
            // The guard reports a fork once, so a copy is asked.
            Some(forks) => forks.clone().detected_fork(),
            None => self.pid != std::process::id(),
        }
    }
}
