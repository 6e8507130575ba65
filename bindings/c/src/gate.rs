//! Gates: their handles, and what all kinds have in common.

use crate::border;
use crate::error::Failure;
use crate::patience::Patience;
use crate::registry::{Locked, Registry};
use crate::status::*;
use scl::bytes::Bytes;
use scl::untyped::Gate;
use std::ffi::{CString, c_char, c_void};
use std::time::Duration;

/// A gate. It belongs to its component and lives as long.
#[allow(non_camel_case_types)]
pub struct scl_gate {
    _opaque: [u8; 0],
}

/// What a gate handle stands for.
pub(crate) struct OpenGate {
    /// `component.gate`, for error texts.
    name: String,
    pub(crate) gate: Gate,
    /// A message that was too long for the buffer of `scl_recv_into`. It is returned before those in the gate's queue.
    pub(crate) kept: Option<Bytes>,
    /// The memory of `scl_buffer`.
    pub(crate) buffer: Vec<u8>,
    pub(crate) patience: Patience,
    /// The gates at the other ends of a `sub` gate's connections, for C.
    senders: Vec<CString>,
}

pub(crate) static GATES: Registry<OpenGate> = Registry::new(5, "gate");

/// The largest buffer that a gate keeps for the next message, in bytes.
const KEPT_CAPACITY: usize = 64 * 1024;

/// Returns true if all required peers are connected or, for `rep` and `pull` gates, at least one peer. False for an
/// invalid handle and for a gate that another thread is using; `scl_error` then says so.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_is_connected(gate: *const scl_gate) -> bool {
    border::value(|| Ok(lock(gate)?.gate.is_connected())).unwrap_or(false)
}

/// Returns the age, in nanoseconds, of the message that a `sub` gate received last, if its publisher has
/// `latched: true` and had sent it before this gate was connected to it. -1 for every other message, before the first
/// one, for gates of other kinds, and for an invalid handle or a gate that another thread is using; `scl_error` then
/// says so.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_latched_age(gate: *const scl_gate) -> i64 {
    let nanoseconds = |age: Duration| i64::try_from(age.as_nanos()).unwrap_or(i64::MAX);
    border::value(|| Ok(lock(gate)?.gate.latched_age().map_or(-1, nanoseconds))).unwrap_or(-1)
}

/// Returns the gate that sent the message that a `sub` gate received last, as `component.gate`: its connection tells.
/// NULL before the first message, for gates of other kinds, and for an invalid handle or a gate that another thread is
/// using; `scl_error` then says so.
///
/// The text is valid until scl_close.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_sender(gate: *const scl_gate) -> *const c_char {
    let sender = border::value(|| Ok(lock(gate)?.sender()));
    sender.unwrap_or(std::ptr::null())
}

/// Gives memory of `len` bytes, in which to make a message for `scl_send` or `scl_call` of this gate. It belongs to the
/// gate and is valid until the next call to that gate; its content is arbitrary. Using it is optional, it spares
/// allocating.
///
/// Errors: SCL_TOO_LONG (no peer accepts a message of this length), SCL_BUSY, SCL_HANDLE, SCL_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_buffer(gate: *mut scl_gate, len: usize, buffer: *mut *mut c_void) -> scl_status {
    let make = || {
        let mut open = lock(gate)?;
        let limit = open.gate.spec().connections.iter().map(|connection| connection.max_size).min().unwrap_or(u64::MAX);
        if len as u64 > limit {
            let name = &open.name;
            let text = format!("gate `{name}` cannot send {len} bytes: at most {limit} are accepted; raise `max_size`");
            return Err(Failure::new(SCL_TOO_LONG, text));
        }
        border::room(&mut open.buffer, len)
    };
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe { border::give(buffer, "buffer", make) })
}

pub(crate) fn insert(component: &str, gate: Gate) -> Result<usize, Failure> {
    let name = format!("{component}.{}", gate.spec().name);
    let peers = gate.spec().connections.iter().filter(|_| matches!(gate, Gate::Sub(_)));
    let peers = peers.map(|peer| format!("{}.{}", peer.peer_component, peer.peer_gate));
    // No name contains a NUL: sockets are named after it.
    let senders = peers.map(|peer| CString::new(peer).unwrap_or_default()).collect();
    GATES.insert(OpenGate { name, gate, kept: None, buffer: Vec::new(), patience: Patience::NONE, senders })
}

/// Locks a gate for one call.
pub(crate) fn lock(gate: *const scl_gate) -> Result<Locked<'static, OpenGate>, Failure> {
    GATES.lock(gate as usize)
}

impl OpenGate {
    /// The sender of the last message, or NULL.
    fn sender(&self) -> *const c_char {
        let connections = self.gate.spec().connections;
        let last = self.gate.last_connection();
        let index = last.and_then(|last| connections.iter().position(|connection| std::ptr::eq(connection, last)));
        index.and_then(|index| self.senders.get(index)).map_or(std::ptr::null(), |sender| sender.as_ptr())
    }

    /// Returns the message that the program sends. It is copied unless it is the whole of the gate's own buffer and
    /// longer than `KEPT_CAPACITY`.
    ///
    /// # Safety
    /// As for `border::bytes`.
    pub(crate) unsafe fn outgoing(&mut self, data: *const c_void, len: usize) -> Result<Bytes, Failure> {
        let own = data.cast::<u8>() == self.buffer.as_ptr() && len == self.buffer.len();
        if own && len > KEPT_CAPACITY {
            return Ok(Bytes::from(std::mem::take(&mut self.buffer)));
        }
        // SAFETY: guaranteed by the caller; NULL with a length and impossible lengths are refused.
        Ok(Bytes::copy_from_slice(unsafe { border::bytes(data, len, "data") }?))
    }

    /// The failure of a call for which the gate has the wrong kind.
    #[cold]
    pub(crate) fn wrong_kind(&self, call: &str) -> Failure {
        let (name, kind) = (&self.name, self.gate.spec().kind.word());
        let advice = match self.gate {
            Gate::Pub(_) | Gate::Push(_) => "scl_send",
            Gate::Sub(_) | Gate::Pull(_) => "scl_recv",
            Gate::Req(_) => "scl_call",
            Gate::Rep(_) => "scl_take_request",
            _ => "another call",
        };
        Failure::new(SCL_KIND, format!("`{call}` is not for `{kind}` gates such as `{name}`; use `{advice}`"))
    }
}
