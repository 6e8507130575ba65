//! Counts of a gate, as JSON.

use crate::border;
use crate::gate::{self, OpenGate, scl_gate};
use crate::status::*;
use scl::PeerStats;
use serde_json::{Value, json};
use std::ffi::{c_char, c_void};
use std::time::Instant;

/// Writes a gate's counts since its component was opened into a buffer of `capacity` bytes, as a JSON object that ends
/// with NUL, and stores its length without the NUL in `*len`:
///
///     {"sent": 2, "received": 0, "replaced": 0, "dropped_oldest": 0, "dropped_newest": 0, "dropped_for_observers": 0,
///      "lost": 0, "rejected": 0, "undecodable": 0, "missed": 0, "expired": 0, "bytes": 12, "waiting": 0,
///      "peers": 1, "idle_ns": 1500000,
///      "connections": [{"peer": "controller.sensor", "connected": true, "published": 2, "taken": 2, "replaced": 0,
///      "dropped_oldest": 0, "dropped_newest": 0, "lost": 0, "waiting": 0}]}
///
/// `idle_ns` is the time since a message last moved, or null. `connections` is empty for gates other than `pub` and
/// `push`.
///
/// Errors: SCL_BUFFER if the buffer is too small: it must be larger than `*len`, and the counts may have grown until
/// the next call. SCL_BUSY, SCL_HANDLE, SCL_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_stats(
    gate: *mut scl_gate,
    buffer: *mut c_char,
    capacity: usize,
    len: *mut usize,
) -> scl_status {
    border::status(|| {
        // SAFETY: guaranteed by the caller; NULL is refused.
        let len = unsafe { border::result(len, "len") }?;
        *len = 0;
        let buffer = buffer.cast::<c_void>();
        border::check_buffer(buffer, capacity)?;
        let mut text = counts(&*gate::lock(gate)?).to_string();
        *len = text.len();
        text.push('\0');
        // SAFETY: the caller guarantees that `capacity` bytes are writable; NULL is refused unless `capacity` is 0.
        unsafe { border::store(text.as_bytes(), buffer, capacity) }
    })
}

fn counts(open: &OpenGate) -> Value {
    let (stats, connections) = (open.gate.stats(), open.gate.peer_stats());
    let idle = stats.last_activity.map(|last| Instant::now().saturating_duration_since(last).as_nanos() as u64);
    json!({
        "sent": stats.sent,
        "received": stats.received,
        "replaced": stats.replaced,
        "dropped_oldest": stats.dropped_oldest,
        "dropped_newest": stats.dropped_newest,
        "dropped_for_observers": stats.dropped_for_observers,
        "lost": stats.lost,
        "rejected": stats.rejected,
        "undecodable": stats.undecodable,
        "missed": stats.missed,
        "expired": stats.expired,
        "bytes": stats.bytes,
        "waiting": stats.waiting + usize::from(open.kept.is_some()),
        "peers": stats.peers,
        "idle_ns": idle,
        "connections": connections.iter().map(connection).collect::<Vec<_>>(),
    })
}

fn connection(stats: &PeerStats) -> Value {
    json!({
        "peer": stats.peer,
        "connected": stats.connected,
        "published": stats.published,
        "taken": stats.taken,
        "replaced": stats.replaced,
        "dropped_oldest": stats.dropped_oldest,
        "dropped_newest": stats.dropped_newest,
        "lost": stats.lost,
        "waiting": stats.waiting,
    })
}
