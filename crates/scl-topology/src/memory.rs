//! The most that SCL holds in memory for the gates of a topology.

use crate::topology::{GateId, Topology};
use scl_plan::memory::GateMemory;

impl Topology {
    /// The most that SCL holds for a gate, in the process of its component.
    pub fn memory_of(&self, id: GateId) -> GateMemory {
        let gate = self.gate(id);
        let peers = gate.connections().iter().map(|&connection| {
            let peer = self.connection(connection).peer_of(id);
            &self.gate(peer).options().program
        });
        GateMemory::of(gate.kind(), gate.options(), peers)
    }
}
