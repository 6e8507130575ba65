//! Calls by threads that are ending.
//!
//! A program may make its last calls late: in destructors of static and thread-local objects, or in `atexit` handlers.
//! By then the thread-local values of this library are destroyed, and tokio panics without its own. Such calls are made
//! on a thread that lives as long as the call.

use crate::error::Failure;
use crate::status::SCL_SYSTEM;
use crate::texts;
use scl::host;
use std::cell::Cell;
use std::thread;

#[derive(Clone, Copy)]
enum Life {
    /// The thread has not called the library yet.
    Unknown,
    Running,
    /// The thread's thread-local values are destroyed.
    Ending,
}

thread_local! {
    // No destructor, so it can be read until the thread is gone.
    static LIFE: Cell<Life> = const { Cell::new(Life::Unknown) };
    static END: End = const { End };
}

/// Marks the thread as ending when it is destroyed.
struct End;

impl Drop for End {
    fn drop(&mut self) {
        LIFE.set(Life::Ending);
    }
}

/// Returns true if thread-local values of the calling thread are destroyed.
pub(crate) fn is_ending() -> bool {
    match LIFE.get() {
        Life::Running => false,
        Life::Ending => true,
        Life::Unknown => {
            LIFE.set(Life::Running);
            // The order matters: `END` is created last and so destroyed first, and marks the thread as ending.
            host::prepare_thread();
            texts::prepare_thread();
            END.with(|_| ());
            false
        }
    }
}

/// Makes a call on another thread and waits for it.
pub(crate) fn call_elsewhere<T>(call: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    let call = Lent(call);
    let result = thread::scope(|threads| {
        let thread = thread::Builder::new().spawn_scoped(threads, move || Lent(call.take()()))?;
        thread.join().map_err(|_panic| std::io::Error::other("the thread that makes this call has panicked"))
    });
    match result {
        Ok(result) => result.take(),
        Err(error) => Err(Failure::of(SCL_SYSTEM, &error)),
    }
}

/// A value that a thread lends to another one; the lender waits until that one is done.
struct Lent<T>(T);

// SAFETY: the two threads never run at the same time, and nothing that a call captures or returns is tied to a thread:
// pointers from the program, failures, and values from the registry. Each lock is released by the thread that took it.
unsafe impl<T> Send for Lent<T> {}

impl<T> Lent<T> {
    fn take(self) -> T {
        self.0
    }
}
