//! The border between C and Rust: panics are caught, pointers are checked before they are used, and calls by threads
//! that are ending are made on another thread.

use crate::error::Failure;
use crate::status::*;
use crate::thread;
use std::any::Any;
use std::ffi::{CStr, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

/// Runs a call and returns its status. A panic becomes `SCL_PANIC`.
pub(crate) fn status(call: impl FnOnce() -> Result<(), Failure>) -> scl_status {
    match value(call) {
        Ok(()) => SCL_OK,
        Err(status) => status,
    }
}

/// Runs a call that returns a value instead of a status. A panic becomes `SCL_PANIC`.
pub(crate) fn value<T>(call: impl FnOnce() -> Result<T, Failure>) -> Result<T, scl_status> {
    let result = if thread::is_ending() { thread::call_elsewhere(|| caught(call)) } else { caught(call) };
    result.map_err(Failure::report)
}

fn caught<T>(call: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    // Unwind safe: after a panic, shared state is only reached through locks, and gates keep their state consistent.
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|payload| Err(panicked(&*payload)))
}

fn panicked(payload: &(dyn Any + Send)) -> Failure {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no text");
    Failure::new(SCL_PANIC, format!("bug in SCL, please report it: {text}"))
}

/// The meaning of a timeout argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wait {
    /// 0: the call does not wait.
    No,
    /// Positive: nanoseconds.
    For(Duration),
    /// Negative: without limit.
    Forever,
}

impl Wait {
    pub(crate) fn of(timeout_ns: i64) -> Self {
        match u64::try_from(timeout_ns) {
            Ok(0) => Self::No,
            Ok(nanoseconds) => Self::For(Duration::from_nanos(nanoseconds)),
            Err(_negative) => Self::Forever,
        }
    }

    /// Returns the time limit as a duration, for calls that take `Duration::MAX` as no limit.
    pub(crate) fn limit(self) -> Duration {
        match self {
            Self::No => Duration::ZERO,
            Self::For(time) => time,
            Self::Forever => Duration::MAX,
        }
    }
}

/// Reads a text argument; NULL and text that is not UTF-8 are errors.
///
/// # Safety
/// `text` is NULL or points to a text that ends with NUL and stays unchanged for `'a`.
pub(crate) unsafe fn text<'a>(text: *const c_char, name: &str) -> Result<&'a str, Failure> {
    if text.is_null() {
        return Err(null(name));
    }
    // SAFETY: not NULL; the caller guarantees the rest.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|_| Failure::argument(format!("`{name}` is not UTF-8: {text:?}")))
}

/// Reads a text argument that may quote bytes of a message: what is not UTF-8 is replaced, NULL is an error.
///
/// # Safety
/// As for [`text`].
pub(crate) unsafe fn lossy_text(text: *const c_char, name: &str) -> Result<String, Failure> {
    if text.is_null() {
        return Err(null(name));
    }
    // SAFETY: not NULL; the caller guarantees the rest.
    Ok(unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned())
}

/// Reads a bytes argument; NULL is an error unless `len` is 0.
///
/// # Safety
/// `data` is NULL or points to `len` bytes that stay unchanged for `'a`.
pub(crate) unsafe fn bytes<'a>(data: *const c_void, len: usize, name: &str) -> Result<&'a [u8], Failure> {
    if data.is_null() {
        return if len == 0 {
            Ok(&[])
        } else {
            Err(Failure::argument(format!("`{name}` is NULL, but `len` is {len}")))
        };
    }
    check_length(len, name)?;
    // SAFETY: not NULL, and not longer than an object can be; the caller guarantees the rest.
    Ok(unsafe { std::slice::from_raw_parts(data.cast(), len) })
}

/// Refuses lengths that no object can have, such as a negative number that became a `size_t`.
fn check_length(len: usize, name: &str) -> Result<(), Failure> {
    match isize::try_from(len) {
        Ok(_) => Ok(()),
        Err(_) => Err(Failure::argument(format!("the length of `{name}` is {len}, which no object can have"))),
    }
}

/// Checks an argument that a result is stored in; NULL is an error.
///
/// # Safety
/// `result` is NULL or points to memory for a `T` that nothing else uses for `'a`.
pub(crate) unsafe fn result<'a, T>(result: *mut T, name: &str) -> Result<&'a mut T, Failure> {
    // SAFETY: guaranteed by the caller.
    unsafe { result.as_mut() }.ok_or_else(|| null(name))
}

/// Stores the pointer that `make` returns, or NULL if it fails.
///
/// # Safety
/// As for [`result`].
pub(crate) unsafe fn give<T>(
    result: *mut *mut T,
    name: &str,
    make: impl FnOnce() -> Result<*mut T, Failure>,
) -> Result<(), Failure> {
    // SAFETY: guaranteed by the caller.
    let result = unsafe { self::result(result, name) }?;
    *result = std::ptr::null_mut();
    *result = make()?;
    Ok(())
}

/// Refuses a buffer of the program that is NULL but not empty, or longer than any object can be.
pub(crate) fn check_buffer(buffer: *const c_void, capacity: usize) -> Result<(), Failure> {
    check_length(capacity, "buffer")?;
    if buffer.is_null() && capacity > 0 {
        return Err(Failure::argument(format!("`buffer` is NULL, but `capacity` is {capacity}")));
    }
    Ok(())
}

/// Copies bytes into a buffer of the program, if it is large enough.
///
/// # Safety
/// `buffer` points to `capacity` bytes that nothing else uses, or `capacity` is 0.
pub(crate) unsafe fn store(bytes: &[u8], buffer: *mut c_void, capacity: usize) -> Result<(), Failure> {
    let needed = bytes.len();
    if needed > capacity {
        let text = format!("the buffer of {capacity} bytes is too small: {needed} are needed; nothing is lost");
        return Err(Failure::new(SCL_BUFFER, text));
    }
    if needed > 0 {
        // SAFETY: `capacity` suffices and is not 0, so the caller guarantees that the buffer is writable. It cannot
        // overlap memory of this library.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), buffer.cast(), needed) };
    }
    Ok(())
}

/// Resizes `buffer` to `len` bytes and returns its start, for the program to write to.
pub(crate) fn room(buffer: &mut Vec<u8>, len: usize) -> Result<*mut c_void, Failure> {
    check_length(len, "buffer")?;
    let missing = len.saturating_sub(buffer.len());
    let no_memory = |_| Failure::new(SCL_SYSTEM, format!("out of memory: cannot allocate {len} bytes"));
    buffer.try_reserve_exact(missing).map_err(no_memory)?;
    // Zero new memory, so a program that writes fewer bytes never sends uninitialized memory.
    buffer.resize(len, 0);
    Ok(buffer.as_mut_ptr().cast())
}

pub(crate) fn null(name: &str) -> Failure {
    Failure::argument(format!("`{name}` is NULL"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::scl_error;

    fn last_error() -> String {
        // SAFETY: texts are never freed.
        unsafe { CStr::from_ptr(scl_error()) }.to_str().unwrap().to_owned()
    }

    #[test]
    fn a_panic_becomes_a_status_with_its_text() {
        let line = 7;
        assert_eq!(status(|| panic!("as expected in line {line}")), SCL_PANIC);
        assert_eq!(last_error(), "bug in SCL, please report it: as expected in line 7");
        assert_eq!(status(|| panic!("plain")), SCL_PANIC);
        assert_eq!(last_error(), "bug in SCL, please report it: plain");
        assert_eq!(status(|| std::panic::panic_any(1)), SCL_PANIC);
        assert_eq!(last_error(), "bug in SCL, please report it: no text");
    }

    #[test]
    fn timeouts_are_none_some_or_endless() {
        assert_eq!(Wait::of(0), Wait::No);
        assert_eq!(Wait::of(1), Wait::For(Duration::from_nanos(1)));
        assert_eq!(Wait::of(-1), Wait::Forever);
        assert_eq!(Wait::of(i64::MIN), Wait::Forever);
    }
}
