//! The process: whether its interpreter is ending.

use pyo3::exceptions::PySystemExit;
use pyo3::prelude::*;
use rustix::thread::gettid;
use std::sync::atomic::{AtomicI32, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

/// Id of the thread that ends the interpreter, 0 before the end.
static EXITING: AtomicI32 = AtomicI32::new(0);
/// Number of threads that have yet to return into the interpreter: they work without it, or run Python code from here.
static INSIDE: AtomicUsize = AtomicUsize::new(0);

/// How often the thread that ends the interpreter checks whether all others have returned.
const RETURN_LOOK: Duration = Duration::from_millis(1);

/// Announces that this thread is about to end the interpreter, and waits until no other thread is in a call that waits.
///
/// By then, all other threads are daemon threads, which Python stops where they are. Those in a call must not return
/// into an interpreter that is gone, and must not stay in the call either: they may hold a lock that ending the
/// interpreter needs, for example that of a logging handler. So their calls raise `SystemExit`, which releases what
/// they hold, and which `threading` does not print.
#[pyfunction]
pub(crate) fn exiting(py: Python<'_>) {
    EXITING.store(this_thread(), Ordering::SeqCst);
    py.detach(|| {
        while INSIDE.load(Ordering::SeqCst) > 0 {
            thread::sleep(RETURN_LOOK);
        }
    });
}

/// Forgets the threads of the parent process, in a forked child.
pub(crate) fn forget_threads() {
    EXITING.store(0, Ordering::SeqCst);
    INSIDE.store(0, Ordering::SeqCst);
}

/// A thread that the end of the interpreter waits for.
pub(crate) struct Inside(());

impl Inside {
    /// Returns `None` if another thread is ending the interpreter.
    pub(crate) fn enter() -> Option<Self> {
        // Increment before checking: either the thread that ends the interpreter sees this count, or this thread sees
        // that the interpreter is ending.
        INSIDE.fetch_add(1, Ordering::SeqCst);
        let inside = Self(());
        (!is_ended_by_another()).then_some(inside)
    }
}

impl Drop for Inside {
    fn drop(&mut self) {
        INSIDE.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Runs `work` with the interpreter released. Fails with `SystemExit` if another thread is ending the interpreter.
pub(crate) fn detach<R: Send>(py: Python<'_>, work: impl FnOnce() -> R + Send) -> PyResult<R> {
    let inside = Inside::enter().ok_or_else(thread_exit)?;
    let result = py.detach(work);
    drop(inside);
    if is_ended_by_another() { Err(thread_exit()) } else { Ok(result) }
}

/// Returns the exception that ends a thread while another one ends the interpreter.
pub(crate) fn thread_exit() -> PyErr {
    PySystemExit::new_err(())
}

fn is_ended_by_another() -> bool {
    let ending = EXITING.load(Ordering::SeqCst);
    ending != 0 && ending != this_thread()
}

fn this_thread() -> i32 {
    gettid().as_raw_pid()
}
