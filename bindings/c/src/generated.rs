//! Functions for code that `scl generate` writes, so that it reports its own failures like those of the library.

use crate::border;
use crate::error::Failure;
use crate::gate::{self, scl_gate};
use crate::request::{self, scl_request};
use crate::status::*;
use scl::untyped::Gate;
use std::ffi::c_char;

/// Keeps `text` as this thread's last error and returns `status`. For generated code.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_fail(status: scl_status, text: *const c_char) -> scl_status {
    border::status(|| {
        // SAFETY: guaranteed by the caller; NULL is refused.
        let text = unsafe { border::text(text, "text") }?;
        Err(Failure::new(status, text))
    })
}

/// Reports that the message or reply that this gate received last cannot be decoded, or this request, which is freed
/// whatever the result: its sender is told, so its call fails. `request` is NULL unless the gate is `rep`. `reason`
/// follows "cannot decode this message: ". It is counted. For generated code and for codecs of your own.
///
/// Returns SCL_OK if the gate skips such messages: receive the next one, with the timeout SCL_REST. They are logged
/// once for each peer.
///
/// Errors: SCL_DECODE for a gate with `undecodable: fail` and for replies; the text names the gate and its peers.
/// SCL_KIND, SCL_HANDLE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_undecodable(
    gate: *mut scl_gate,
    request: *mut scl_request,
    reason: *const c_char,
) -> scl_status {
    border::status(|| {
        // SAFETY: guaranteed by the caller; NULL is refused.
        let reason = unsafe { border::lossy_text(reason, "reason") }?;
        // SAFETY: not NULL, so the caller guarantees that the request is live.
        let request = (!request.is_null()).then(|| unsafe { request::remove(request) }).transpose()?;
        let mut open = gate::lock(gate)?;
        let reported = match (&open.gate, request) {
            (Gate::Sub(_) | Gate::Pull(_) | Gate::Req(_), _) => open.gate.reject(reason),
            (Gate::Rep(_), Some(request)) => open.gate.reject_request(request, reason),
            (Gate::Rep(_), None) => return Err(border::null("request")),
            _ => return Err(open.wrong_kind("scl_undecodable")),
        };
        reported.map_err(|error| Failure::of(SCL_DECODE, error.inner()))
    })
}
