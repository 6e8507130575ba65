//! The gates that a gate without a peer may have been meant for, found without comparing each with each.

use super::draft::Draft;
use crate::topology::GateKind;
use std::collections::HashMap;

/// Maximum number of gates that a help names. A search looks at no more than [`SEARCHED`] candidates of each list.
const MOST: usize = 3;
const SEARCHED: usize = 32;

/// Gates of each kind, by their names, the names of their components, and their types.
#[derive(Default)]
pub(super) struct FittingGates<'m> {
    by_gate: HashMap<(&'static str, &'m str), Vec<usize>>,
    by_component: HashMap<(&'static str, &'m str), Vec<usize>>,
    by_type: HashMap<(&'static str, &'m str), Vec<usize>>,
    all: HashMap<&'static str, Vec<usize>>,
    /// By gate: its connections whose ends fit, with the gate at the other end.
    peers: Vec<Vec<(usize, usize)>>,
}

impl<'m> FittingGates<'m> {
    pub(super) fn of(draft: &Draft<'m>) -> Self {
        let mut gates = Self { peers: draft.links_by_gate(), ..Self::default() };
        for (at, gate) in draft.gates.iter().enumerate() {
            let Some(kind) = gate.kind.map(GateKind::word).filter(|_| !gate.duplicate) else { continue };
            gates.all.entry(kind).or_default().push(at);
            gates.by_gate.entry((kind, &gate.model.name.value)).or_default().push(at);
            gates.by_component.entry((kind, draft.component_name(at))).or_default().push(at);
            if let Some(payload) = &gate.model.payload {
                gates.by_type.entry((kind, payload.value.trim())).or_default().push(at);
            }
        }
        gates
    }

    /// The gates to which a gate is connected, as far as a search looks at them.
    pub(super) fn peers(&self, gate: usize) -> impl Iterator<Item = usize> + '_ {
        self.peers.get(gate).into_iter().flatten().take(SEARCHED).map(|(_, peer)| *peer)
    }

    /// The connection of a sender in which another receiver of the same name, which has more senders, stands in the
    /// place of this one.
    pub(super) fn misled(&self, draft: &Draft<'m>, sender: usize, receiver: usize) -> Option<(usize, usize)> {
        let name = &draft.gates[receiver].model.name.value;
        let is_twin = |&&(_, peer): &&(usize, usize)| {
            draft.gates[peer].model.name.value == *name && peer != receiver && self.peers[peer].len() > 1
        };
        let (link, twin) = self.peers.get(sender)?.iter().take(SEARCHED).find(is_twin)?;
        // The first connection of the other one is its own.
        (self.peers[*twin].first()?.0 != *link).then_some((*link, *twin))
    }

    /// Returns at most three gates that fit a gate: first those with its name, then gates of a component with its name,
    /// then those with its type, then any if the file has no more than three of their kind.
    pub(super) fn for_gate(&self, draft: &Draft<'m>, gate: usize) -> Vec<usize> {
        let model = draft.gates[gate].model;
        let Some(kind) = draft.gates[gate].kind.map(|kind| kind.opposite().word()) else { return Vec::new() };
        let payload = model.payload.as_ref().map(|payload| payload.value.trim());
        let name = (kind, model.name.value.as_str());
        let few = self.all.get(kind).filter(|all| all.len() <= MOST);
        let lists = [
            self.by_gate.get(&name),
            self.by_component.get(&name),
            payload.and_then(|payload| self.by_type.get(&(kind, payload))),
            few,
        ];
        let mut found: Vec<usize> = Vec::new();
        for other in lists.into_iter().flatten().flat_map(|list| list.iter().take(SEARCHED).copied()) {
            if found.len() < MOST && !found.contains(&other) && fits(draft, other, gate) {
                found.push(other);
            }
        }
        found
    }
}

fn fits(draft: &Draft<'_>, other: usize, gate: usize) -> bool {
    let are_known = draft.gates[other].payload.is_some() && draft.gates[gate].payload.is_some();
    are_known && draft.may_connect(other, gate) && draft.component_name(other) != draft.component_name(gate)
}
