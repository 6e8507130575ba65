//! Telling a forked child from its parent, to which all handles belong.

use std::ffi::c_int;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of forks between this process and the one that loaded the library.
static FORKS: AtomicUsize = AtomicUsize::new(0);

/// What the standard library does not offer of the C library.
///
/// cbindgen:ignore
mod libc {
    use std::ffi::c_int;

    type Handler = Option<unsafe extern "C" fn()>;

    unsafe extern "C" {
        pub(super) fn pthread_atfork(prepare: Handler, parent: Handler, child: Handler) -> c_int;
    }
}

unsafe extern "C" fn count_fork() {
    FORKS.fetch_add(1, Ordering::Relaxed);
}

/// Starts to count. Called before the first handle is given out.
pub(crate) fn watch() {
    static WATCHED: OnceLock<c_int> = OnceLock::new();
    // SAFETY: the handler is a function of this library, which is never unloaded (it has thread-local values), and it
    // only adds to an atomic number, which is allowed in a forked child. A failure, for want of memory, leaves the
    // check to the crate `scl`, which has one of its own.
    WATCHED.get_or_init(|| unsafe { libc::pthread_atfork(None, None, Some(count_fork)) });
}

/// A number that differs between a process and its forked children.
pub(crate) fn count() -> usize {
    FORKS.load(Ordering::Relaxed)
}
