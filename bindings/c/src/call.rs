//! Calls: `req` gates.

use crate::border::{self, Wait};
use crate::gate::{self, scl_gate};
use crate::message::{self, scl_message};
use crate::status::*;
use scl::untyped::Gate;
use std::ffi::c_void;

/// Sends a request of `len` bytes, which are copied, over a `req` gate and waits for the reply. A negative timeout
/// means the gate's own, from the topology file. A replier that is not connected yet is waited for within that time.
///
/// On success, `*reply` is the reply, to be freed with scl_message_free; otherwise it is NULL.
///
/// Calls of one gate follow each other, also with `in_flight`: SCL_BUSY says that another thread is calling. For
/// several calls at once, declare several gates.
///
/// Errors: SCL_TIMEOUT, SCL_PEER_LOST, SCL_REFUSED, SCL_TOO_LONG, SCL_ENCODE, SCL_KIND, SCL_STOPPED, SCL_CLOSED,
/// SCL_BUSY, SCL_HANDLE. A reply that comes too late is discarded; the next call never receives it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_call(
    gate: *mut scl_gate,
    data: *const c_void,
    len: usize,
    timeout_ns: i64,
    reply: *mut *mut scl_message,
) -> scl_status {
    let call = || {
        let mut open = gate::lock(gate)?;
        // SAFETY: guaranteed by the caller.
        let request = unsafe { open.outgoing(data, len) }?;
        let reply = match (&mut open.gate, Wait::of(timeout_ns)) {
            (Gate::Req(gate), Wait::Forever) => gate.call_blocking(&request)?,
            (Gate::Req(gate), wait) => gate.call_timeout(&request, wait.limit())?,
            _ => return Err(open.wrong_kind("scl_call")),
        };
        Ok(message::hand_over(reply))
    };
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe { border::give(reply, "message", call) })
}
