//! SCL1701: gates that may hold more than the `memory` of their component allows. SCL0409 for bounds out of range.

mod fitting;

use super::draft::Draft;
use super::option::VALUE;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity, removal};
use crate::grammar::{self, MEMORY, MEMORY_SHAPE, OutOfRange};
use crate::source::{Span, Spanned};
use crate::topology::GateKind;
use crate::work;
use fitting::{Limit, proposal};
use scl_plan::GateOptions;
use scl_plan::memory::{GateMemory, sum};
use scl_text::size;
use std::collections::HashSet;

/// SCL1701.
pub(crate) const RULE: Rule = Rule {
    code: "SCL1701",
    severity: Severity::Error,
    title: "gates may hold more than `memory` allows",
    explanation: "The component declares how much memory the messages in its gates may take, and its gates may hold \
                  more. Messages wait in the component that sends them: up to `queue` messages of up to `max_size` \
                  bytes, as the receiving gates declare. Receiving gates have queues of that size, too, and some \
                  messages are on their way. With the defaults, 100 messages of 64MiB, one gate may hold more than \
                  6GiB. Declare the `max_size` that the messages need, or a shorter `queue`, or raise the bound. \
                  `scl plan --memory` shows what each gate may hold.",
    example: " components:
   - name: camera
     memory: 64MiB
     gates:
       - frames: {pub: Image}
   - name: detector
     gates:
-      - frames: {sub: Image}
+      - frames: {sub: Image, queue: 10, max_size: 4MiB}
 connections:
   - [camera.frames, detector.frames]
",
};

/// How many gates a problem names.
const MOST_NAMED: usize = 3;

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let bounds = bounds(draft, problems);
    // The options of a gate with an error are not those that are meant.
    if bounds.is_empty() || problems.has_errors() {
        return;
    }
    let reach = Reach { draft, links: draft.links_by_gate() };
    // Components of a kind share their bound, and are reported together.
    let mut reported: HashSet<Span> = HashSet::new();
    for bound in bounds {
        let held = reach.held(bound.component, None);
        let total = total(&held);
        if total > bound.bytes {
            let found = headline(draft, &bound, total);
            let is_first = reported.insert(bound.written.span);
            problems.push(if is_first { reach.explained(found, &bound, held, total) } else { found });
        }
    }
}

/// The bound of a component.
struct Bound<'m> {
    component: usize,
    written: &'m Spanned<String>,
    bytes: u64,
}

fn bounds<'m>(draft: &Draft<'m>, problems: &mut Diagnostics) -> Vec<Bound<'m>> {
    let mut bounds = Vec::new();
    for (component, written) in draft.components.iter().map(|component| component.model.memory.as_ref()).enumerate() {
        let Some(written) = written else { continue };
        match grammar::memory(&written.value) {
            Ok(bytes) => bounds.push(Bound { component, written, bytes }),
            Err(range) => problems.push(out_of_range(draft, written, &range)),
        }
    }
    bounds
}

fn out_of_range(draft: &Draft<'_>, written: &Spanned<String>, range: &OutOfRange) -> Diagnostic {
    let found = VALUE.at(format!("`{MEMORY}` must be {}", range.rule), written.span, "");
    let found = match MEMORY_SHAPE.largest().filter(|_| range.is_too_large) {
        Some(largest) => {
            let edit = Edit::new(written.span, &*largest);
            found.suggest(format!("the largest is `{MEMORY}: {largest}`"), [edit])
        }
        None => found,
    };
    let file = draft.sources.file(written.span.file);
    let start = file.text()[..written.span.start as usize].rfind(MEMORY);
    let entry = start.map(|start| Span { start: start as u32, ..written.span });
    match entry.and_then(|entry| removal(file, entry)) {
        Some(removed) => found.suggest("without it, the component has no bound", [removed]),
        None => found,
    }
}

fn headline(draft: &Draft<'_>, bound: &Bound<'_>, total: u64) -> Diagnostic {
    let name = &draft.components[bound.component].model.name.value;
    let (held, allowed) = (size::rounded(total), &bound.written.value);
    let headline = format!("the gates of `{name}` may hold {held}, more than `{MEMORY}: {allowed}` allows");
    RULE.at(headline, bound.written.span, "the bound")
}

/// A gate, and what it may hold.
struct Held {
    gate: usize,
    memory: GateMemory,
}

fn total(held: &[Held]) -> u64 {
    sum(held.iter().map(|held| held.memory.total()))
}

/// The gates, and those at the other ends of their connections.
struct Reach<'d, 'm> {
    draft: &'d Draft<'m>,
    links: Vec<Vec<(usize, usize)>>,
}

impl Reach<'_, '_> {
    /// What the gates of a component may hold, or would hold with a limit.
    fn held(&self, component: usize, limit: Option<Limit>) -> Vec<Held> {
        let gates = self.draft.components[component].gates.iter();
        gates.filter_map(|&gate| Some(Held { gate, memory: self.memory(gate, limit)? })).collect()
    }

    fn memory(&self, gate: usize, limit: Option<Limit>) -> Option<GateMemory> {
        let options = |gate: usize| {
            work::add(1);
            let options = &self.draft.gates[gate].options.program;
            limit.map_or_else(|| options.clone(), |limit| limit.applied(options))
        };
        let peers: Vec<GateOptions> = self.peers(gate).map(options).collect();
        Some(GateMemory::of(self.draft.gates[gate].kind?, &options(gate), &peers))
    }

    fn peers(&self, gate: usize) -> impl Iterator<Item = usize> {
        self.links[gate].iter().map(|(_, peer)| *peer)
    }

    /// Adds which gates hold most, and what would fit.
    fn explained(&self, found: Diagnostic, bound: &Bound<'_>, mut held: Vec<Held>, total: u64) -> Diagnostic {
        held.retain(|held| held.memory.total() > 0);
        held.sort_by_key(|held| std::cmp::Reverse(held.memory.total()));
        let (named, others) = held.split_at(held.len().min(MOST_NAMED));
        let labels = named.iter().map(|held| (self.draft.gates[held.gate].model.name.span, composition(&held.memory)));
        let sends = |held: &Held| matches!(self.draft.gates[held.gate].kind, Some(GateKind::Pub | GateKind::Push));
        let waits = "messages wait at the sender: `queue` and `max_size` are those of the receiving gate";
        let rest = format!("{} other gates may hold {}", others.len(), size::rounded(self::total(others)));
        let found = found
            .labels(labels)
            .notes((!others.is_empty()).then_some(rest))
            .notes(named.iter().any(sends).then_some(waits));
        let found = Limit::ALL.into_iter().fold(found, |found, limit| proposal(self, found, bound, limit));
        match fitting::bound(total) {
            Some(larger) => {
                let edit = Edit::new(bound.written.span, &*larger);
                let text = format!("or raise the bound: `{MEMORY}: {larger}`");
                // Words remain if a raised bound brings to light what else is wrong.
                found.suggest(text.clone(), [edit]).otherwise(text)
            }
            None => found,
        }
    }
}

/// `6.38GiB: 100 x 64MiB in queues, 128MiB in flight`.
fn composition(memory: &GateMemory) -> String {
    let waiting = format!("{} x {} in queues", memory.messages, size::rounded(memory.longest));
    let parts = [
        (memory.waiting(), waiting),
        (memory.in_flight, format!("{} in flight", size::rounded(memory.in_flight))),
        (memory.latched, format!("{} latched", size::rounded(memory.latched))),
    ];
    let parts: Vec<String> = parts.into_iter().filter(|(bytes, _)| *bytes > 0).map(|(_, text)| text).collect();
    match parts.as_slice() {
        [part] if memory.waiting() == 0 => part.clone(),
        parts => format!("{}: {}", size::rounded(memory.total()), parts.join(", ")),
    }
}

#[cfg(test)]
mod tests;
