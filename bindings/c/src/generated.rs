//! For code that `scl generate` writes: failures of its own, told like those of the library.

use crate::border;
use crate::error::Failure;
use crate::gate::{self, scl_gate};
use crate::status::*;
use std::ffi::c_char;

/// Keeps `text` as this thread's last error and returns `status`. For generated code.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_fail(status: scl_status, text: *const c_char) -> scl_status {
    border::status(|| {
        // SAFETY: the caller's duty; NULL is refused.
        let text = unsafe { border::text(text, "text") }?;
        Err(Failure::new(status, text))
    })
}

/// Counts a message, request or reply of this gate as undecodable, keeps the error with the names of the gate and its
/// peers, and returns SCL_DECODE. `type` is what it should have been: `rover.Measurement`. For generated code.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_undecodable(gate: *mut scl_gate, r#type: *const c_char) -> scl_status {
    border::status(|| {
        // SAFETY: the caller's duty; NULL is refused.
        let expected = unsafe { border::text(r#type, "type") }?;
        let mut open = gate::lock(gate)?;
        match open.gate.reject(format!("it is not a `{expected}`")) {
            Some(error) => Err(Failure::of(SCL_DECODE, error.inner())),
            None => Err(open.wrong_kind("scl_undecodable")),
        }
    })
}
