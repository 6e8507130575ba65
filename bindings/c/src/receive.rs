//! Receiving: `sub` and `pull` gates.

use crate::border::{self, Wait};
use crate::error::Failure;
use crate::gate::{self, scl_gate};
use crate::message::{self, scl_message};
use crate::status::*;
use scl::bytes::Bytes;
use scl::untyped::Gate;

pub(crate) const NOTHING: Failure = Failure::usual(SCL_NOTHING, c"no message has arrived yet");

/// Receives the next message of a `sub` or `pull` gate. A timeout of 0 does not wait, a negative one waits without
/// limit.
///
/// On success, `*message` is the message, to be freed with scl_message_free; otherwise it is NULL.
///
/// Errors: SCL_NOTHING (timeout 0), SCL_TIMEOUT (the text says which peers are missing), SCL_KIND, SCL_STOPPED,
/// SCL_CLOSED, SCL_BUSY, SCL_HANDLE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_recv(gate: *mut scl_gate, timeout_ns: i64, message: *mut *mut scl_message) -> scl_status {
    // SAFETY: the caller's duty; NULL is refused.
    border::status(|| unsafe { give(message, || receive(&mut gate::lock(gate)?.gate, Wait::of(timeout_ns))) })
}

/// Returns the newest message that has arrived at a `sub` or `pull` gate and discards the older ones. It does not wait.
///
/// On success, `*message` is the message, to be freed with scl_message_free; otherwise it is NULL.
///
/// Errors: SCL_NOTHING, and those of scl_recv.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_latest(gate: *mut scl_gate, message: *mut *mut scl_message) -> scl_status {
    // SAFETY: the caller's duty; NULL is refused.
    border::status(|| unsafe { give(message, || newest(&mut gate::lock(gate)?.gate)) })
}

fn receive(gate: &mut Gate, wait: Wait) -> Result<Bytes, Failure> {
    match (gate, wait) {
        (Gate::Sub(gate), Wait::No) => gate.try_recv()?.ok_or(NOTHING),
        (Gate::Pull(gate), Wait::No) => gate.try_recv()?.ok_or(NOTHING),
        (Gate::Sub(gate), Wait::For(time)) => Ok(gate.recv_timeout(time)?),
        (Gate::Pull(gate), Wait::For(time)) => Ok(gate.recv_timeout(time)?),
        (Gate::Sub(gate), Wait::Forever) => Ok(gate.recv_blocking()?),
        (Gate::Pull(gate), Wait::Forever) => Ok(gate.recv_blocking()?),
        (other, _) => Err(gate::wrong_kind(other, "scl_recv")),
    }
}

fn newest(gate: &mut Gate) -> Result<Bytes, Failure> {
    match gate {
        Gate::Sub(gate) => gate.latest()?.ok_or(NOTHING),
        Gate::Pull(gate) => gate.latest()?.ok_or(NOTHING),
        other => Err(gate::wrong_kind(other, "scl_latest")),
    }
}

/// Stores what a call receives, or NULL.
///
/// # Safety
/// That of `border::result`.
pub(crate) unsafe fn give(
    result: *mut *mut scl_message,
    receive: impl FnOnce() -> Result<Bytes, Failure>,
) -> Result<(), Failure> {
    // SAFETY: the caller's duty.
    let result = unsafe { border::result(result, "message") }?;
    *result = std::ptr::null_mut();
    *result = message::hand_over(receive()?);
    Ok(())
}
