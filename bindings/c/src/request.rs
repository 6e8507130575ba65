//! Requests and replies: `rep` gates.

use crate::border::{self, Wait};
use crate::error::Failure;
use crate::gate::{self, OpenGate, scl_gate};
use crate::receive::NOTHING;
use crate::status::*;
use scl::Request;
use scl::bytes::Bytes;
use scl::untyped::Gate;
use std::ffi::c_void;

/// A request. It belongs to the caller, who answers it with scl_reply or frees it with scl_request_free.
#[allow(non_camel_case_types)]
pub struct scl_request {
    mark: u64,
    request: Request<Bytes, Bytes>,
    /// The memory of `scl_reply_buffer`.
    buffer: Vec<u8>,
}

/// Found at the beginning of every live request, and of no message.
const MARK: u64 = u64::from_be_bytes(*b"scl_requ");

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
    border::status(|| {
        // SAFETY: the caller's duty; NULL is refused.
        let result = unsafe { border::result(request, "request") }?;
        *result = std::ptr::null_mut();
        let request = take(&mut *gate::lock(gate)?, timeout_ns)?;
        *result = Box::into_raw(Box::new(scl_request { mark: MARK, request, buffer: Vec::new() }));
        Ok(())
    })
}

/// Returns the bytes of a request, and stores their number in `*len` unless `len` is NULL. They are valid until
/// scl_reply or scl_request_free.
///
/// A NULL request gives NULL and the length 0, and is no error. A request that was answered or freed must not be used,
/// which cannot be detected.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_request_data(request: *const scl_request, len: *mut usize) -> *const c_void {
    let data = match request.is_null() {
        // Not an error: the call that returned no request has set the text.
        true => None,
        // SAFETY: not NULL, and the caller promises a live request.
        false => border::value(|| Ok(unsafe { live(request) }?.request.message())).ok(),
    };
    let (start, length) = data.map_or((std::ptr::null(), 0), |data| (data.as_ptr(), data.len()));
    // SAFETY: the caller promises a `size_t` or NULL.
    if let Some(len) = unsafe { len.as_mut() } {
        *len = length;
    }
    start.cast()
}

/// Answers a request with `len` bytes, which are copied. It never waits. The request is freed, whatever the result,
/// except for SCL_ARGUMENT and SCL_HANDLE.
///
/// Errors: SCL_REQUESTER_GONE (it disconnected, which a replier may well ignore), SCL_TOO_LONG, SCL_ENCODE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_reply(request: *mut scl_request, data: *const c_void, len: usize) -> scl_status {
    border::status(|| {
        // SAFETY: the caller promises a live request or NULL.
        unsafe { live(request) }?;
        // SAFETY: the bytes are the caller's duty.
        let data = unsafe { border::bytes(data, len, "data") }?;
        // Before the request is freed, which the bytes may belong to.
        let reply = Bytes::copy_from_slice(data);
        // SAFETY: just found to be live.
        Ok(unsafe { take_back(request) }.reply(&reply)?)
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
    border::status(|| {
        // SAFETY: the caller's duty; NULL is refused.
        let result = unsafe { border::result(buffer, "buffer") }?;
        *result = std::ptr::null_mut();
        // SAFETY: the caller promises a live request or NULL.
        unsafe { live(request) }?;
        // SAFETY: just found to be live; nothing else refers to this field.
        *result = border::room(unsafe { &mut (*request).buffer }, len)?;
        Ok(())
    })
}

/// Frees a request that is not to be answered; its sender waits until its timeout. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_request_free(request: *mut scl_request) {
    if request.is_null() {
        return;
    }
    let _reported = border::value(|| {
        // SAFETY: the caller promises a live request.
        unsafe { live(request) }?;
        // SAFETY: just found to be live.
        drop(unsafe { take_back(request) });
        Ok(())
    });
}

fn take(open: &mut OpenGate, timeout_ns: i64) -> Result<Request<Bytes, Bytes>, Failure> {
    let wait = open.patience.of(timeout_ns).ok_or(NOTHING)?;
    match (&mut open.gate, wait) {
        (Gate::Rep(gate), Wait::No) => gate.try_recv()?.ok_or(NOTHING),
        (Gate::Rep(gate), Wait::For(time)) => Ok(gate.recv_timeout(time)?),
        (Gate::Rep(gate), Wait::Forever) => Ok(gate.recv_blocking()?),
        _ => Err(open.wrong_kind("scl_take_request")),
    }
}

/// The request of a handle, which is freed.
///
/// # Safety
/// `request` is NULL, or points to at least 8 readable bytes.
pub(crate) unsafe fn remove(request: *mut scl_request) -> Result<Request<Bytes, Bytes>, Failure> {
    // SAFETY: the caller's duty.
    unsafe { live(request) }?;
    // SAFETY: just found to be live.
    Ok(unsafe { take_back(request) })
}

/// # Safety
/// `request` is live.
unsafe fn take_back(request: *mut scl_request) -> Request<Bytes, Bytes> {
    // SAFETY: made by `Box::into_raw` and, being live, was not freed before.
    let mut request = unsafe { Box::from_raw(request) };
    request.mark = 0;
    std::hint::black_box(&request.mark);
    request.request
}

/// # Safety
/// `request` is NULL, or points to at least 8 readable bytes.
unsafe fn live<'a>(request: *const scl_request) -> Result<&'a scl_request, Failure> {
    if request.is_null() {
        return Err(border::null("request"));
    }
    let wrong = || Failure::new(SCL_HANDLE, "this is not a request: it was answered or freed, or never was one");
    if !request.is_aligned() {
        return Err(wrong());
    }
    // SAFETY: aligned, and the caller promises the memory.
    if unsafe { (&raw const (*request).mark).read() } != MARK {
        return Err(wrong());
    }
    // SAFETY: only live requests have the mark.
    Ok(unsafe { &*request })
}
