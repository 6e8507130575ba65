//! Received messages, owned by the caller.

use crate::marked::{Kind, Marked};
use scl::bytes::Bytes;
use std::ffi::c_void;

/// A received message. It belongs to the caller, who frees it with scl_message_free.
#[allow(non_camel_case_types)]
pub struct scl_message {
    _opaque: [u8; 0],
}

struct Message(Bytes);

impl Kind for Message {
    const MARK: u64 = u64::from_be_bytes(*b"scl_mesg");
    const NAME: &str = "message";
    const GONE: &str = "was freed";

    fn bytes(&self) -> &Bytes {
        &self.0
    }
}

/// Returns the bytes of a message, and stores their number in `*len` unless `len` is NULL. The bytes are those that
/// were received, without a copy; they are valid until scl_message_free. An empty message gives a pointer that is not
/// NULL.
///
/// A NULL message gives NULL and the length 0, and is no error. A message that was freed must not be used, which cannot
/// be detected.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_message_data(message: *const scl_message, len: *mut usize) -> *const c_void {
    // SAFETY: the caller guarantees that the message is live or NULL, and that `len` is NULL or points to a `size_t`.
    unsafe { Marked::<Message>::data(message.cast(), len) }
}

/// Frees a message. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_message_free(message: *mut scl_message) {
    // SAFETY: the caller guarantees that the message is live or NULL.
    unsafe { Marked::<Message>::free(message.cast()) };
}

/// Gives a message to the caller.
pub(crate) fn hand_over(data: Bytes) -> *mut scl_message {
    Marked::hand_over(Message(data)).cast()
}
