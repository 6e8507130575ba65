//! Received messages, owned by the caller.

use crate::border;
use crate::error::Failure;
use crate::status::*;
use scl::bytes::Bytes;
use std::ffi::c_void;

/// A received message. It belongs to the caller, who frees it with scl_message_free.
#[allow(non_camel_case_types)]
pub struct scl_message {
    mark: u64,
    data: Bytes,
}

/// Found at the beginning of every live message, and of no request.
const MARK: u64 = u64::from_be_bytes(*b"scl_mesg");

/// Returns the bytes of a message, and stores their number in `*len` unless `len` is NULL. The bytes are those that
/// were received, without a copy; they are valid until scl_message_free. An empty message gives a pointer that is not
/// NULL.
///
/// A NULL message gives NULL and the length 0, and is no error. A message that was freed must not be used, which cannot
/// be detected.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_message_data(message: *const scl_message, len: *mut usize) -> *const c_void {
    let data = match message.is_null() {
        // Not an error: the call that returned no message has set the text.
        true => None,
        // SAFETY: not NULL, and the caller promises a live message.
        false => border::value(|| Ok(&unsafe { live(message) }?.data)).ok(),
    };
    let (start, length) = data.map_or((std::ptr::null(), 0), |data| (data.as_ptr(), data.len()));
    // SAFETY: the caller promises a `size_t` or NULL.
    if let Some(len) = unsafe { len.as_mut() } {
        *len = length;
    }
    start.cast()
}

/// Frees a message. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_message_free(message: *mut scl_message) {
    if message.is_null() {
        return;
    }
    let _reported = border::value(|| {
        // SAFETY: the caller promises a live message.
        unsafe { live(message) }?;
        // SAFETY: it was made by `Box::into_raw` and, being live, was not freed before.
        let mut message = unsafe { Box::from_raw(message) };
        // So that a second free is more likely to be noticed than to free again.
        message.mark = 0;
        std::hint::black_box(&message.mark);
        drop(message);
        Ok(())
    });
}

/// Gives a message to the caller.
pub(crate) fn hand_over(data: Bytes) -> *mut scl_message {
    Box::into_raw(Box::new(scl_message { mark: MARK, data }))
}

/// # Safety
/// `message` is NULL, or points to at least 8 readable bytes.
unsafe fn live<'a>(message: *const scl_message) -> Result<&'a scl_message, Failure> {
    if message.is_null() {
        return Err(border::null("message"));
    }
    let wrong = || Failure::new(SCL_HANDLE, "this is not a message: it was freed, or never was one");
    if !message.is_aligned() {
        return Err(wrong());
    }
    // SAFETY: aligned, and the caller promises the memory.
    if unsafe { (&raw const (*message).mark).read() } != MARK {
        return Err(wrong());
    }
    // SAFETY: only live messages have the mark.
    Ok(unsafe { &*message })
}
