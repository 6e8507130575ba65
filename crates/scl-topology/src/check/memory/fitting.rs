//! Values of `max_size`, `queue` and `memory` with which the gates of a component fit into its bound.

use super::{Bound, Reach, total};
use crate::diagnostic::{Diagnostic, Edit};
use crate::grammar::memory;
use crate::topology::GateKind;
use scl_plan::GateOptions;
use scl_text::list::listed;
use scl_text::size;

/// A limit for all gates in question: those of the component, and their peers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Limit {
    /// Of the length of a message, in bytes.
    MaxSize(u64),
    /// Of the messages in a queue.
    Queue(u32),
}

/// The lengths of queues that are proposed.
const QUEUES: [u32; 18] =
    [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10_000, 20_000, 50_000, 100_000, 200_000, 500_000];

/// The binary logarithms of the lengths of messages that are proposed: 1 KiB to 512 MiB.
const SIZES: std::ops::Range<u32> = 10..30;

/// Maximum number of gates at which a proposal changes an option.
const MOST_CHANGED: usize = 10;

impl Limit {
    /// One of each, to be replaced by the one that fits.
    pub(super) const ALL: [Self; 2] = [Self::MaxSize(0), Self::Queue(0)];

    pub(super) fn applied(self, options: &GateOptions) -> GateOptions {
        match self {
            Self::MaxSize(most) => GateOptions { max_size: options.max_size.min(most), ..options.clone() },
            Self::Queue(most) => GateOptions { queue: options.queue.min(most), ..options.clone() },
        }
    }

    fn key(self) -> &'static str {
        match self {
            Self::MaxSize(_) => "max_size",
            Self::Queue(_) => "queue",
        }
    }

    fn value(self) -> String {
        match self {
            Self::MaxSize(most) => size::text(most),
            Self::Queue(most) => most.to_string(),
        }
    }

    /// All limits of this kind, the lowest first.
    fn choices(self) -> Vec<Self> {
        match self {
            Self::MaxSize(_) => SIZES.map(|exponent| Self::MaxSize(1 << exponent)).collect(),
            Self::Queue(_) => QUEUES.into_iter().map(Self::Queue).collect(),
        }
    }
}

/// Proposes the highest limit of this kind with which the gates fit into the bound, if there is one.
pub(super) fn proposal(reach: &Reach<'_, '_>, found: Diagnostic, bound: &Bound<'_>, limit: Limit) -> Diagnostic {
    let choices = limit.choices();
    let held = |limit: Limit| total(&reach.held(bound.component, Some(limit)));
    let fitting = choices.partition_point(|limit| held(*limit) <= bound.bytes);
    let Some(limit) = fitting.checked_sub(1).map(|last| choices[last]) else { return found };
    let gates = changed(reach, bound.component, limit);
    if gates.is_empty() {
        return found;
    }
    let draft = reach.draft;
    let entry = format!("{}: {}", limit.key(), limit.value());
    let text = format!(
        "write `{entry}` at {}; the gates then hold at most {}",
        names(reach, &gates),
        size::rounded(held(limit))
    );
    if gates.len() > MOST_CHANGED {
        return found.help(text);
    }
    let mut edits: Vec<Edit> = Vec::new();
    for gate in gates {
        let edit = draft.with_option(gate, limit.key(), &limit.value());
        if !edits.contains(&edit) {
            edits.push(edit);
        }
    }
    found.suggest(text, edits)
}

fn names(reach: &Reach<'_, '_>, gates: &[usize]) -> String {
    let mut names: Vec<String> = gates.iter().map(|gate| reach.draft.shared_path(*gate)).collect();
    names.dedup();
    listed(names)
}

/// The gates whose option must be lower for a limit to hold.
fn changed(reach: &Reach<'_, '_>, component: usize, limit: Limit) -> Vec<usize> {
    let draft = reach.draft;
    let exceeds = |gate: &usize| {
        let options = &draft.gates[*gate].options.program;
        limit.applied(options) != *options
    };
    let mut changed: Vec<usize> = Vec::new();
    for &gate in &draft.components[component].gates {
        let (is_own, has_peers) = match (draft.gates[gate].kind, limit) {
            (None, _) | (Some(GateKind::Req | GateKind::Rep), Limit::Queue(_)) => (false, false),
            (Some(GateKind::Req | GateKind::Rep), Limit::MaxSize(_)) => (true, true),
            (Some(GateKind::Pub | GateKind::Push), _) => (false, true),
            (Some(GateKind::Sub | GateKind::Pull), _) => (true, false),
        };
        let own = is_own.then_some(gate);
        let peers = reach.peers(gate).filter(|_| has_peers);
        match limit {
            // A sender refuses what one of its peers does not accept, so the lowest `max_size` counts.
            Limit::MaxSize(_) => {
                let lowest = peers.min_by_key(|peer| draft.gates[*peer].options.max_size);
                changed.extend(own.into_iter().chain(lowest).filter(exceeds));
            }
            Limit::Queue(_) => changed.extend(own.into_iter().chain(peers).filter(exceeds)),
        }
    }
    changed.sort_unstable();
    changed.dedup();
    changed
}

/// A value of `memory` that allows this much: in MiB, or in KiB if it is less than one.
pub(super) fn bound(total: u64) -> Option<String> {
    let unit: u64 = if total < 1 << 20 { 1 << 10 } else { 1 << 20 };
    let bound = total.div_ceil(unit).checked_mul(unit)?;
    let text = size::text(bound);
    memory(&text).is_ok().then_some(text)
}
