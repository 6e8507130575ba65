//! Telling a forked child from its parent, to which all handles belong.

use std::ffi::c_int;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of forks between this process and the one that loaded the library.
static FORKS: AtomicUsize = AtomicUsize::new(0);

/// Functions of the C library that the standard library does not offer.
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

/// Starts to count forks. Called before the first handle is given out.
pub(crate) fn watch() {
    static WATCHED: OnceLock<c_int> = OnceLock::new();
    // SAFETY: the handler is a function of this library, which is never unloaded because it has thread-local values. It
    // only increments an atomic counter, which is allowed in a forked child. If registering it fails because memory is
    // exhausted, the crate `scl` still detects forks by itself.
    WATCHED.get_or_init(|| unsafe { libc::pthread_atfork(None, None, Some(count_fork)) });
}

/// A number that differs between a process and its forked children.
pub(crate) fn count() -> usize {
    FORKS.load(Ordering::Relaxed)
}
