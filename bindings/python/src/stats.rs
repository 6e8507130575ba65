//! The counts of a gate as a dictionary.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use scl::untyped::Gate;
use scl::{GateStats, PeerStats};
use std::time::Instant;

/// The counts of a gate and of its connections.
pub(crate) struct Stats {
    gate: GateStats,
    peers: Vec<PeerStats>,
}

pub(crate) fn of_gate(gate: &Gate) -> Stats {
    let peers = match gate {
        Gate::Pub(gate) => gate.peer_stats(),
        Gate::Push(gate) => gate.peer_stats(),
        _ => Vec::new(),
    };
    Stats { gate: gate.stats(), peers }
}

impl Stats {
    pub(crate) fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        counts(&dict, &self.gate)?;
        let connections = self.peers.iter().map(|peer| of_peer(py, peer)).collect::<PyResult<Vec<_>>>()?;
        dict.set_item("connections", connections)?;
        Ok(dict)
    }
}

fn counts(dict: &Bound<'_, PyDict>, stats: &GateStats) -> PyResult<()> {
    let idle = stats.last_activity.map(|last| Instant::now().saturating_duration_since(last).as_secs_f64());
    dict.set_item("sent", stats.sent)?;
    dict.set_item("received", stats.received)?;
    dict.set_item("replaced", stats.replaced)?;
    dict.set_item("dropped_oldest", stats.dropped_oldest)?;
    dict.set_item("dropped_newest", stats.dropped_newest)?;
    dict.set_item("dropped_for_observers", stats.dropped_for_observers)?;
    dict.set_item("lost", stats.lost)?;
    dict.set_item("rejected", stats.rejected)?;
    dict.set_item("undecodable", stats.undecodable)?;
    dict.set_item("bytes", stats.bytes)?;
    dict.set_item("waiting", stats.waiting)?;
    dict.set_item("peers", stats.peers)?;
    dict.set_item("idle_seconds", idle)
}

fn of_peer<'py>(py: Python<'py>, stats: &PeerStats) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("peer", &stats.peer)?;
    dict.set_item("connected", stats.connected)?;
    dict.set_item("published", stats.published)?;
    dict.set_item("taken", stats.taken)?;
    dict.set_item("replaced", stats.replaced)?;
    dict.set_item("dropped_oldest", stats.dropped_oldest)?;
    dict.set_item("dropped_newest", stats.dropped_newest)?;
    dict.set_item("lost", stats.lost)?;
    dict.set_item("waiting", stats.waiting)?;
    Ok(dict)
}
