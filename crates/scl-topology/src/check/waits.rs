//! Which component can wait for which, and where. `docs/deadlocks.md` explains the same to users.
//!
//! A call that sends may wait; a call that receives waits for a message, which says nothing about its sender. A reply
//! never waits.

use super::circles::Step;
use super::draft::Draft;
use crate::topology::{GateKind, WhenFull};

/// The kind of call that waits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Call {
    /// A message for a queue that is full. Waits until there is room, however long that takes.
    Send,
    /// A request. Its timeout ends the wait, but the call has failed then.
    Request {
        /// Whether the file sets the timeout.
        has_timeout: bool,
    },
}

/// A call at which a component can wait: for an answer, or for room in a queue.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Wait {
    pub(super) call: Call,
    /// The steps to the components that it waits for. A `push` gate that shares its work has several: it waits only
    /// while the queues of all its pullers are full.
    pub(super) steps: Vec<Step>,
}

impl Wait {
    pub(super) fn from(&self) -> usize {
        self.steps[0].from
    }

    /// Whether the component waits only for itself.
    pub(super) fn is_for_itself(&self) -> bool {
        self.steps.iter().all(|step| step.from == step.to)
    }
}

/// All waits, in the order of their connections.
pub(super) fn all(draft: &Draft<'_>) -> Vec<Wait> {
    let mut waits = Vec::new();
    let mut shared: Vec<Vec<(Step, bool)>> = vec![Vec::new(); draft.gates.len()];
    for (link, source, sink) in draft.flows() {
        let step = step(draft, link, source, sink);
        match draft.gates[source].kind {
            Some(GateKind::Push) => shared[source].push((step, can_wait(draft, source, sink))),
            Some(GateKind::Req) => {
                let has_timeout = draft.gates[source].option("timeout").is_some();
                waits.push(Wait { call: Call::Request { has_timeout }, steps: vec![step] });
            }
            _ if can_wait(draft, source, sink) => waits.push(Wait { call: Call::Send, steps: vec![step] }),
            _ => {}
        }
    }
    // A connection that could not be read may lead to a puller that never makes the pusher wait.
    for gate in draft.links.iter().filter(|link| link.flow.is_none()).flat_map(|link| link.ends).flatten() {
        shared[gate].clear();
    }
    let waiting = shared.into_iter().filter(|steps| !steps.is_empty() && steps.iter().all(|(_, can_wait)| *can_wait));
    let steps = waiting.map(|steps| steps.into_iter().map(|(step, _)| step).collect());
    waits.extend(steps.map(|steps| Wait { call: Call::Send, steps }));
    waits.sort_unstable_by_key(|wait| wait.steps[0].link);
    waits
}

/// Whether sending at `source` can wait for room in the queue of `sink`.
pub(super) fn can_wait(draft: &Draft<'_>, source: usize, sink: usize) -> bool {
    let sends = matches!(draft.gates[source].kind, Some(GateKind::Pub | GateKind::Push));
    sends && draft.gates[source].options.backpressure && draft.gates[sink].options.when_full == WhenFull::Wait
}

/// Which gates wait for which.
pub(super) struct Waiting {
    /// By gate: how many receivers make it wait.
    pub(super) receivers: Vec<usize>,
    /// By gate: the senders that it makes wait.
    pub(super) senders: Vec<Vec<usize>>,
}

impl Waiting {
    pub(super) fn of(draft: &Draft<'_>) -> Self {
        let count = draft.gates.len();
        let mut waiting = Self { receivers: vec![0; count], senders: vec![Vec::new(); count] };
        for (_, source, sink) in draft.flows().filter(|&(_, source, sink)| can_wait(draft, source, sink)) {
            waiting.receivers[source] += 1;
            waiting.senders[sink].push(source);
        }
        waiting
    }
}

/// The step of a connection from its sending to its receiving component. A component that is declared twice counts as
/// one.
pub(super) fn step(draft: &Draft<'_>, link: usize, source: usize, sink: usize) -> Step {
    let component = |gate| draft.component(draft.component_name(gate)).unwrap_or(draft.gates[gate].component);
    Step { link, from: component(source), to: component(sink) }
}
