//! Requests and replies: `rep` gates.

use crate::border::{self, Wait};
use crate::error::Failure;
use crate::gate::{self, OpenGate, scl_gate};
use crate::marked::{Kind, Marked};
use crate::receive::{NOTHING, receive_from};
use crate::status::*;
use scl::Request;
use scl::bytes::Bytes;
use scl::untyped::Gate;
use std::ffi::c_void;

/// A request. It belongs to the caller, who answers it with scl_reply or frees it with scl_request_free.
#[allow(non_camel_case_types)]
pub struct scl_request {
    _opaque: [u8; 0],
}

struct Taken {
    request: Request<Bytes, Bytes>,
    /// The memory of `scl_reply_buffer`.
    buffer: Vec<u8>,
}

impl Kind for Taken {
    const MARK: u64 = u64::from_be_bytes(*b"scl_requ");
    const NAME: &str = "request";
    const GONE: &str = "was answered or freed";

    fn bytes(&self) -> &Bytes {
        self.request.message()
    }
}

/// Receives the next request of a `rep` gate. A timeout of 0 does not wait, a negative one waits without limit.
///
/// On success, `*request` is the request, to be answered with scl_reply or freed with scl_request_free; otherwise it is
/// NULL. Requests may be answered later, in any order, and from any thread.
///
/// Errors: SCL_NOTHING (timeout 0), SCL_TIMEOUT, SCL_KIND, SCL_STOPPED, SCL_CLOSED, SCL_BUSY, SCL_HANDLE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_take_request(
    gate: *mut scl_gate,
    timeout_ns: i64,
    request: *mut *mut scl_request,
) -> scl_status {
    let take = || {
        let request = take(&mut *gate::lock(gate)?, timeout_ns)?;
        Ok(Marked::hand_over(Taken { request, buffer: Vec::new() }).cast())
    };
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe { border::give(request, "request", take) })
}

/// Returns the bytes of a request, and stores their number in `*len` unless `len` is NULL. They are valid until
/// scl_reply or scl_request_free.
///
/// A NULL request gives NULL and the length 0, and is no error. A request that was answered or freed must not be used,
/// which cannot be detected.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_request_data(request: *const scl_request, len: *mut usize) -> *const c_void {
    // SAFETY: the caller guarantees that the request is live or NULL, and that `len` is NULL or points to a `size_t`.
    unsafe { Marked::<Taken>::data(request.cast(), len) }
}

/// Answers a request with `len` bytes, which are copied. It never waits. The request is freed, whatever the result,
/// except for SCL_ARGUMENT and SCL_HANDLE.
///
/// Errors: SCL_REQUESTER_GONE (it disconnected, which a replier may well ignore), SCL_TOO_LONG, SCL_ENCODE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_reply(request: *mut scl_request, data: *const c_void, len: usize) -> scl_status {
    border::status(|| {
        // SAFETY: the caller guarantees that the request is live or NULL.
        unsafe { Marked::<Taken>::live(request.cast()) }?;
        // SAFETY: guaranteed by the caller.
        let data = unsafe { border::bytes(data, len, "data") }?;
        // Copy before the request is freed: the bytes may belong to it.
        let reply = Bytes::copy_from_slice(data);
        // SAFETY: the check above has found the request to be live.
        Ok(unsafe { remove(request) }?.reply(&reply)?)
    })
}

/// Gives memory of `len` bytes, in which to make a reply for `scl_reply`. It belongs to the request and is valid as
/// long; its content is arbitrary. Using it is optional, it spares freeing.
///
/// Errors: SCL_HANDLE, SCL_ARGUMENT, SCL_SYSTEM (no memory).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_reply_buffer(
    request: *mut scl_request,
    len: usize,
    buffer: *mut *mut c_void,
) -> scl_status {
    let make = || {
        // SAFETY: the caller guarantees that the request is live or NULL.
        unsafe { Marked::<Taken>::live(request.cast()) }?;
        // SAFETY: the check above has found the request to be live; nothing else refers to this field.
        border::room(unsafe { &mut (*request.cast::<Marked<Taken>>()).inner.buffer }, len)
    };
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe { border::give(buffer, "buffer", make) })
}

/// Frees a request that is not to be answered; its sender waits until its timeout. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_request_free(request: *mut scl_request) {
    // SAFETY: the caller guarantees that the request is live or NULL.
    unsafe { Marked::<Taken>::free(request.cast()) };
}

fn take(open: &mut OpenGate, timeout_ns: i64) -> Result<Request<Bytes, Bytes>, Failure> {
    let wait = open.patience.of(timeout_ns).ok_or(NOTHING)?;
    match &mut open.gate {
        Gate::Rep(gate) => receive_from!(gate, wait),
        _ => Err(open.wrong_kind("scl_take_request")),
    }
}

/// Frees the handle of a request and returns the request.
///
/// # Safety
/// `request` is NULL, or points to at least 8 readable bytes.
pub(crate) unsafe fn remove(request: *mut scl_request) -> Result<Request<Bytes, Bytes>, Failure> {
    // SAFETY: guaranteed by the caller.
    Ok(unsafe { Marked::<Taken>::take_back(request.cast()) }?.request)
}
