//! The names of sockets in the folder of a system.

use super::contract::{contract, gate_contract};
use super::{CONTRACT_LENGTH, TAP};
use crate::fingerprint;
use crate::topology::{ConnectionId, GateId, GateKind, Topology};
use scl_text::gate_name::gate_in_file_name;

/// The name of a connection's socket.
///
/// For `pub` and `sub` it is `<pub>.<gate>--<sub>.<gate>.<contract>`. Where the longest usual folder leaves no room for
/// that, the end of the gates' names is replaced by `~` and a fingerprint of them; the contract always stays the part
/// after the last dot. For `req` and `push` it is the socket of the gate at the other end, see [`gate_endpoint`].
pub(super) fn endpoint(topology: &Topology, connection: ConnectionId) -> String {
    let link = topology.connection(connection);
    if let Some(own) = gate_endpoint(topology, link.sink()) {
        return own;
    }
    let pair = format!("{}--{}", in_file_name(topology, link.source()), in_file_name(topology, link.sink()));
    format!("{}.{}", shortened(&pair, topology.connection_room), contract(topology, connection))
}

/// The name of the socket at which a `rep` or `pull` gate listens for all its peers: `<component>.<gate>.<contract>`.
/// The other kinds have none.
pub(super) fn gate_endpoint(topology: &Topology, gate: GateId) -> Option<String> {
    let listens = matches!(topology.gate(gate).kind(), GateKind::Rep | GateKind::Pull);
    listens.then(|| format!("{}.{}", in_file_name(topology, gate), gate_contract(topology, gate)))
}

/// The name of the socket at which tools observe a `pub`, `rep` or `pull` gate: `<component>.<gate>.tap`. The other
/// kinds have none.
///
/// No contract is `tap`, and no other file of a component has this ending, so gates may be called `lock` or `json`.
pub(super) fn tap_endpoint(topology: &Topology, gate: GateId) -> Option<String> {
    topology.gate(gate).kind().listens().then(|| format!("{}{TAP}", in_file_name(topology, gate)))
}

/// A gate in the name of a socket: `left_arm+planner.command`.
fn in_file_name(topology: &Topology, gate: GateId) -> String {
    let gate = topology.gate(gate);
    gate_in_file_name(topology.component(gate.component()).name(), gate.name())
}

/// Shortens the names of a connection's gates to `room` bytes, with a fingerprint at their end. Checked names are
/// ASCII, so they can be cut after any byte.
pub(crate) fn shortened(pair: &str, room: usize) -> String {
    if pair.len() <= room {
        return pair.to_owned();
    }
    let kept = room.saturating_sub(1 + CONTRACT_LENGTH);
    format!("{}~{}", pair.get(..kept).unwrap_or(""), fingerprint::short([pair]))
}
