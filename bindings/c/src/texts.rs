//! The texts of a thread's last errors, where a C program can read them.
//!
//! A program may hold on to a text while other calls fail, if only by calling `scl_error` twice in one expression. So a
//! thread keeps several, and their memory is never freed: it is used again, by this thread or by a later one.

use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::ffi::{CStr, c_char};
use std::mem;
use std::sync::{Mutex, PoisonError};

/// Number of texts that are kept for a thread. The documentation of `scl_error` promises it.
const KEPT: usize = 16;
/// Smallest capacity of a buffer: enough for most texts, so that buffers are seldom replaced by larger ones.
const SMALLEST: usize = 256;

thread_local! {
    // No destructor, so it can be used for as long as the thread makes calls.
    static LAST: Cell<*const c_char> = const { Cell::new(c"".as_ptr()) };
    static TEXTS: RefCell<Texts> = const { RefCell::new(Texts::new()) };
}

/// Buffers that no thread uses now.
static SPARE: Mutex<Vec<Buffer>> = Mutex::new(Vec::new());

/// The texts of threads whose own `TEXTS` are destroyed.
static OF_ENDING_THREADS: Mutex<Texts> = Mutex::new(Texts::new());

/// The last text of this thread.
pub(crate) fn last() -> *const c_char {
    LAST.get()
}

/// Creates the thread-local storage for the texts of this thread. It is destroyed before thread-local values that were
/// created earlier.
pub(crate) fn prepare_thread() {
    let _kept = TEXTS.try_with(|_| ());
}

/// Keeps a text as this thread's last error.
pub(crate) fn keep(text: Cow<'static, CStr>) {
    LAST.set(match text {
        Cow::Borrowed(text) => text.as_ptr(),
        Cow::Owned(text) => TEXTS
            .try_with(|texts| texts.borrow_mut().keep(&text))
            .unwrap_or_else(|_| OF_ENDING_THREADS.lock().unwrap_or_else(PoisonError::into_inner).keep(&text)),
    });
}

struct Texts {
    buffers: [Buffer; KEPT],
    next: usize,
}

impl Texts {
    const fn new() -> Self {
        Self { buffers: [const { Buffer::NONE }; KEPT], next: 0 }
    }

    /// Writes a text in place of the oldest one.
    fn keep(&mut self, text: &CStr) -> *const c_char {
        let bytes = text.to_bytes_with_nul();
        let buffer = &mut self.buffers[self.next];
        self.next = (self.next + 1) % KEPT;
        if buffer.capacity < bytes.len() {
            mem::replace(buffer, Buffer::of(bytes.len())).spare();
        }
        // SAFETY: the buffer has room for the bytes and belongs to these texts alone. C code cannot read it at the same
        // time: this thread is inside this call, and other threads must not use its texts once it makes further calls.
        unsafe { buffer.start.copy_from_nonoverlapping(bytes.as_ptr(), bytes.len()) };
        buffer.start.cast()
    }
}

impl Drop for Texts {
    fn drop(&mut self) {
        self.buffers.iter_mut().for_each(|buffer| mem::replace(buffer, Buffer::NONE).spare());
    }
}

/// Memory that is never freed.
struct Buffer {
    start: *mut u8,
    capacity: usize,
}

// SAFETY: only the owner of a buffer writes to its memory.
unsafe impl Send for Buffer {}

impl Buffer {
    const NONE: Self = Self { start: std::ptr::null_mut(), capacity: 0 };

    fn of(len: usize) -> Self {
        let mut spare = SPARE.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(index) = spare.iter().position(|buffer| buffer.capacity >= len) {
            return spare.swap_remove(index);
        }
        let capacity = len.next_power_of_two().max(SMALLEST);
        Self { start: Box::leak(vec![0; capacity].into_boxed_slice()).as_mut_ptr(), capacity }
    }

    fn spare(self) {
        if self.capacity > 0 {
            SPARE.lock().unwrap_or_else(PoisonError::into_inner).push(self);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::CString;

    fn keep_text(text: &str) -> *const c_char {
        keep(Cow::Owned(CString::new(text).unwrap()));
        last()
    }

    fn read(text: *const c_char) -> String {
        // SAFETY: texts are never freed, and no other thread has used this one since.
        unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned()
    }

    #[test]
    fn a_text_stays_while_15_others_follow() {
        let first = keep_text("first");
        for number in 1..KEPT {
            // Longer ones, too, which need memory of their own.
            keep_text(&format!("{number}").repeat(1000));
            assert_eq!(read(first), "first");
        }
        assert_eq!(keep_text("another"), first);
    }

    #[test]
    fn the_memory_of_threads_that_have_ended_is_used_again() {
        let long = "x".repeat(100_000);
        let used = || {
            std::thread::spawn({
                let long = long.clone();
                move || keep_text(&long) as usize
            })
            .join()
            .unwrap()
        };
        let first = used();
        assert!((0..3).all(|_| used() == first));
    }
}
