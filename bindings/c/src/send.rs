//! Sending: `pub` and `push` gates.

use crate::border::{self, Wait};
use crate::error::Failure;
use crate::gate::{self, OpenGate, scl_gate};
use crate::status::*;
use scl::bytes::Bytes;
use scl::untyped::Gate;
use std::ffi::c_void;

/// Sends a message of `len` bytes over a `pub` or `push` gate. The bytes are copied.
///
/// Only a gate with `backpressure: true` waits, for a peer with `when_full: wait` whose queue is full. A timeout of 0
/// does not wait, a negative one waits without limit.
///
/// Errors: SCL_FULL (timeout 0), SCL_TIMEOUT, SCL_TOO_LONG, SCL_ENCODE, SCL_KIND, SCL_STOPPED, SCL_CLOSED, SCL_BUSY,
/// SCL_HANDLE. After any of them the message was sent to no peer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_send(gate: *mut scl_gate, data: *const c_void, len: usize, timeout_ns: i64) -> scl_status {
    border::status(|| {
        let mut open = gate::lock(gate)?;
        // SAFETY: guaranteed by the caller.
        let message = unsafe { open.outgoing(data, len) }?;
        send(&mut open, &message, Wait::of(timeout_ns))
    })
}

fn send(open: &mut OpenGate, message: &Bytes, wait: Wait) -> Result<(), Failure> {
    match (&mut open.gate, wait) {
        (Gate::Pub(gate), Wait::No) => Ok(gate.try_send(message)?),
        (Gate::Pub(gate), Wait::For(time)) => Ok(gate.send_timeout(message, time)?),
        (Gate::Pub(gate), Wait::Forever) => Ok(gate.send_blocking(message)?),
        (Gate::Push(gate), Wait::No) => Ok(gate.try_send(message)?),
        (Gate::Push(gate), Wait::For(time)) => Ok(gate.send_timeout(message, time)?),
        (Gate::Push(gate), Wait::Forever) => Ok(gate.send_blocking(message)?),
        _ => Err(open.wrong_kind("scl_send")),
    }
}
