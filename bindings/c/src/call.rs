//! Calls: `req` gates.

use crate::border;
use crate::gate::{self, scl_gate};
use crate::message::scl_message;
use crate::receive::give;
use crate::status::*;
use scl::bytes::Bytes;
use scl::untyped::Gate;
use std::ffi::c_void;

/// Sends a request of `len` bytes over a `req` gate and waits for the reply. A negative timeout is the gate's own, from
/// the topology file.
///
/// On success, `*reply` is the reply, to be freed with scl_message_free; otherwise it is NULL.
///
/// Errors: SCL_TIMEOUT, SCL_PEER_LOST, SCL_TOO_LONG, SCL_KIND, SCL_STOPPED, SCL_CLOSED, SCL_BUSY, SCL_HANDLE. A reply
/// that comes too late is discarded; the next call never receives it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_call(
    gate: *mut scl_gate,
    data: *const c_void,
    len: usize,
    timeout_ns: i64,
    reply: *mut *mut scl_message,
) -> scl_status {
    let _ = timeout_ns;
    let call = || {
        let mut open = gate::lock(gate)?;
        // SAFETY: the caller's duty; NULL and impossible lengths are refused.
        let request = Bytes::copy_from_slice(unsafe { border::bytes(data, len, "data") }?);
        match &mut open.gate {
            Gate::Req(gate) => Ok(gate.call_blocking(&request)?),
            other => Err(gate::wrong_kind(other, "scl_call")),
        }
    };
    // SAFETY: the caller's duty; NULL is refused.
    border::status(|| unsafe { give(reply, call) })
}
