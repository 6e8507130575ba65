//! Receiving: `sub` and `pull` gates.

use crate::border::{self, Wait};
use crate::error::Failure;
use crate::gate::{self, OpenGate, scl_gate};
use crate::message::{self, scl_message};
use crate::status::*;
use scl::bytes::Bytes;
use scl::untyped::Gate;
use std::ffi::c_void;

/// The usual result of a call that does not wait.
pub(crate) const NOTHING: Failure = Failure::usual(SCL_NOTHING, c"no message has arrived yet");

/// Receives from a gate of any kind that receives.
macro_rules! receive_from {
    ($gate:expr, $wait:expr) => {
        match $wait {
            Wait::No => $gate.try_recv()?.ok_or(NOTHING),
            Wait::For(time) => Ok($gate.recv_timeout(time)?),
            Wait::Forever => Ok($gate.recv_blocking()?),
        }
    };
}
pub(crate) use receive_from;

/// Receives the next message of a `sub` or `pull` gate. A timeout of 0 does not wait, a negative one waits without
/// limit.
///
/// On success, `*message` is the message, to be freed with scl_message_free; otherwise it is NULL.
///
/// Errors: SCL_NOTHING (timeout 0), SCL_TIMEOUT (the text says which peers are missing), SCL_KIND, SCL_STOPPED,
/// SCL_CLOSED, SCL_BUSY, SCL_HANDLE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_recv(gate: *mut scl_gate, timeout_ns: i64, message: *mut *mut scl_message) -> scl_status {
    let receive = || Ok(message::hand_over(receive(&mut *gate::lock(gate)?, timeout_ns)?));
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe { border::give(message, "message", receive) })
}

/// Receives the next message of a `sub` or `pull` gate into a buffer of `capacity` bytes, and stores its length in
/// `*len`. The variant of scl_recv without anything to free.
///
/// Errors: SCL_BUFFER if the buffer is too small: `*len` is the size needed, and the next call returns the same
/// message, unless scl_latest finds a newer one. `buffer` may be NULL if `capacity` is 0. Otherwise those of scl_recv,
/// and `*len` is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_recv_into(
    gate: *mut scl_gate,
    buffer: *mut c_void,
    capacity: usize,
    len: *mut usize,
    timeout_ns: i64,
) -> scl_status {
    border::status(|| {
        // SAFETY: guaranteed by the caller; NULL is refused.
        let len = unsafe { border::result(len, "len") }?;
        *len = 0;
        border::check_buffer(buffer, capacity)?;
        let mut open = gate::lock(gate)?;
        let message = receive(&mut open, timeout_ns)?;
        *len = message.len();
        // SAFETY: the caller guarantees that `capacity` bytes are writable; NULL is refused unless `capacity` is 0.
        let stored = unsafe { border::store(&message, buffer, capacity) };
        if stored.is_err() {
            open.kept = Some(message);
        }
        stored
    })
}

/// Returns the newest message that has arrived at a `sub` or `pull` gate and discards the older ones. It does not wait.
///
/// On success, `*message` is the message, to be freed with scl_message_free; otherwise it is NULL.
///
/// Errors: SCL_NOTHING, and those of scl_recv.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_latest(gate: *mut scl_gate, message: *mut *mut scl_message) -> scl_status {
    let newest = || Ok(message::hand_over(newest(&mut *gate::lock(gate)?)?));
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe { border::give(message, "message", newest) })
}

/// Stores in `*missed` how many messages a `sub` or `pull` gate has missed since the last call, because its `deadline`
/// passed without one. It does not wait. Each is told once, those of all senders together.
///
/// Errors: SCL_FAILED if the gate declares no `deadline`, SCL_KIND, SCL_STOPPED, SCL_CLOSED, SCL_BUSY, SCL_HANDLE,
/// SCL_ARGUMENT. `*missed` is 0 then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_take_missed(gate: *mut scl_gate, missed: *mut u64) -> scl_status {
    border::status(|| {
        // SAFETY: guaranteed by the caller; NULL is refused.
        let missed = unsafe { border::result(missed, "missed") }?;
        *missed = 0;
        let mut open = gate::lock(gate)?;
        *missed = match &mut open.gate {
            Gate::Sub(gate) => gate.take_missed()?,
            Gate::Pull(gate) => gate.take_missed()?,
            _ => return Err(open.wrong_kind("scl_take_missed")),
        };
        Ok(())
    })
}

fn receive(open: &mut OpenGate, timeout_ns: i64) -> Result<Bytes, Failure> {
    if let Some(kept) = open.kept.take() {
        return Ok(kept);
    }
    let wait = open.patience.of(timeout_ns).ok_or(NOTHING)?;
    match &mut open.gate {
        Gate::Sub(gate) => receive_from!(gate, wait),
        Gate::Pull(gate) => receive_from!(gate, wait),
        _ => Err(open.wrong_kind("scl_recv")),
    }
}

fn newest(open: &mut OpenGate) -> Result<Bytes, Failure> {
    let newest = match &mut open.gate {
        Gate::Sub(gate) => gate.latest()?,
        Gate::Pull(gate) => gate.latest()?,
        _ => return Err(open.wrong_kind("scl_latest")),
    };
    // A kept message is older than all messages in the gate's queue.
    let kept = open.kept.take();
    newest.or(kept).ok_or(NOTHING)
}
