//! The senders that a receiver without one may have been meant for, found without comparing each with each.

use super::draft::Draft;
use crate::topology::{GateKind, Payload};
use std::collections::HashMap;

/// Maximum number of senders that a help names. A search looks at no more than [`SEARCHED`] candidates of each list.
const MOST: usize = 3;
const SEARCHED: usize = 32;

/// Senders by the names of their gates and components, and by their types.
#[derive(Default)]
pub(super) struct FittingSenders<'m> {
    by_gate: HashMap<&'m str, Vec<usize>>,
    by_component: HashMap<&'m str, Vec<usize>>,
    by_type: HashMap<&'m str, Vec<usize>>,
    all: Vec<usize>,
}

impl<'m> FittingSenders<'m> {
    pub(super) fn of(draft: &Draft<'m>) -> Self {
        let mut senders = Self::default();
        for (at, gate) in draft.gates.iter().enumerate() {
            if !matches!(gate.kind, Some(GateKind::Pub | GateKind::Push)) || gate.duplicate {
                continue;
            }
            senders.all.push(at);
            senders.by_gate.entry(&gate.model.name.value).or_default().push(at);
            senders.by_component.entry(draft.component_name(at)).or_default().push(at);
            if let Some(payload) = &gate.model.payload {
                senders.by_type.entry(payload.value.trim()).or_default().push(at);
            }
        }
        senders
    }

    /// Returns at most three senders that fit a receiver: first those with its name, then gates of a component with its
    /// name, then those with its type, then any if the file has no more than three.
    pub(super) fn for_gate(&self, draft: &Draft<'m>, gate: usize) -> Vec<usize> {
        let name = draft.gates[gate].model.name.value.as_str();
        let payload = draft.gates[gate].model.payload.as_ref().map(|payload| payload.value.trim());
        let few = if self.all.len() <= MOST { self.all.as_slice() } else { &[] };
        let listed = [self.by_gate.get(name), self.by_component.get(name), payload.and_then(|p| self.by_type.get(p))];
        let lists = listed.into_iter().flatten().map(Vec::as_slice).chain([few]);
        let mut found: Vec<usize> = Vec::new();
        for sender in lists.flat_map(|list| list.iter().take(SEARCHED).copied()) {
            if found.len() < MOST && !found.contains(&sender) && fits(draft, sender, gate) {
                found.push(sender);
            }
        }
        found
    }
}

fn fits(draft: &Draft<'_>, sender: usize, receiver: usize) -> bool {
    let [from, to] = [sender, receiver].map(|gate| &draft.gates[gate]);
    let kinds_fit = to.kind.map(GateKind::opposite) == from.kind;
    let types_fit = match (&from.payload, &to.payload) {
        (Some(Payload::Message(a)), Some(Payload::Message(b))) => a.dotted() == b.dotted(),
        (Some(_), Some(_)) => true,
        _ => false,
    };
    kinds_fit && types_fit && draft.component_name(sender) != draft.component_name(receiver)
}
