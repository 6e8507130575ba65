//! The counts of a gate as a dictionary.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use scl::{GateStats, PeerStats};
use std::time::Instant;

/// The counts of a gate and of its connections.
pub(crate) fn to_dict<'py>(py: Python<'py>, gate: &GateStats, peers: &[PeerStats]) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    counts(&dict, gate)?;
    let connections = peers.iter().map(|peer| of_peer(py, peer)).collect::<PyResult<Vec<_>>>()?;
    dict.set_item("connections", connections)?;
    Ok(dict)
}

/// Sets items by the names of the fields.
macro_rules! set_fields {
    ($dict:ident, $stats:ident: $($field:ident),+ $(,)?) => {
        $($dict.set_item(stringify!($field), &$stats.$field)?;)+
    };
}

fn counts(dict: &Bound<'_, PyDict>, stats: &GateStats) -> PyResult<()> {
    let idle = stats.last_activity.map(|last| Instant::now().saturating_duration_since(last).as_secs_f64());
    set_fields!(dict, stats: sent, received, replaced, dropped_oldest, dropped_newest, dropped_for_observers, lost);
    set_fields!(dict, stats: rejected, undecodable, missed, expired, bytes, waiting, peers);
    dict.set_item("idle_seconds", idle)
}

fn of_peer<'py>(py: Python<'py>, stats: &PeerStats) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    set_fields!(dict, stats: peer, connected, published, taken, replaced, dropped_oldest, dropped_newest, lost, waiting);
    Ok(dict)
}
