//! `scl plan --memory`: the most that SCL holds in memory for each gate, as a table or as JSON.

use crate::format::FormatArgument;
use scl_plan::memory::{GateMemory, sum};
use scl_plan::{GateKind, GateOptions};
use scl_terminal::{Table, print_err};
use scl_text::list::listed;
use scl_text::size::{rounded, text};
use scl_topology::topology::{Component, ComponentId, Gate, GateId, Kind, Topology};
use serde_json::{Value, json};
use std::cmp::Reverse;
use std::collections::HashMap;

/// Prints what the gates of these components may hold.
pub(super) fn print(topology: &Topology, components: &[ComponentId], format: FormatArgument) {
    let held: Vec<Held<'_>> = components.iter().map(|component| Held::of(topology, *component)).collect();
    format.print(|| as_json(topology, &held), || as_table(topology, &held));
    if !format.is_json() {
        advice(topology, &held).iter().for_each(|line| print_err(&format!("  = {line}\n")));
    }
}

/// A component, and what its gates may hold.
struct Held<'t> {
    component: &'t Component,
    kind: Option<&'t Kind>,
    gates: Vec<HeldByGate<'t>>,
}

struct HeldByGate<'t> {
    id: GateId,
    gate: &'t Gate,
    memory: GateMemory,
}

impl<'t> Held<'t> {
    fn of(topology: &'t Topology, component: ComponentId) -> Self {
        let component = topology.component(component);
        let of_gate = |&id: &GateId| HeldByGate { id, gate: topology.gate(id), memory: topology.memory_of(id) };
        let gates = component.gates().iter().map(of_gate).collect();
        Self { component, kind: component.kind().map(|kind| topology.kind(kind)), gates }
    }

    fn sum(&self, of: impl Fn(&GateMemory) -> u64) -> u64 {
        sum(self.gates.iter().map(|held| of(&held.memory)))
    }

    fn total(&self) -> u64 {
        self.sum(GateMemory::total)
    }

    /// Whether another component of the kind may hold as much, gate by gate.
    fn is_like(&self, other: &Self) -> bool {
        let [own, others] = [self, other].map(|held| held.gates.iter().map(|held| held.memory));
        self.component.memory() == other.component.memory() && own.eq(others)
    }
}

fn system_total(held: &[Held<'_>]) -> u64 {
    sum(held.iter().map(Held::total))
}

/// All numbers are bytes, except `messages`.
fn as_json(topology: &Topology, held: &[Held<'_>]) -> Value {
    let gate = |HeldByGate { gate, memory, .. }: &HeldByGate<'_>| {
        json!({
            "name": gate.name(), "kind": gate.kind().word(), "total": memory.total(), "messages": memory.messages,
            "longest": memory.longest, "waiting": memory.waiting(), "in_flight": memory.in_flight,
            "latched": memory.latched,
        })
    };
    let component = |held: &Held<'_>| {
        json!({
            "name": held.component.name(), "kind": held.kind.map(Kind::name), "bound": held.component.memory(),
            "total": held.total(), "gates": held.gates.iter().map(gate).collect::<Vec<_>>(),
        })
    };
    let components: Vec<Value> = held.iter().map(component).collect();
    json!({ "system": topology.system(), "total": system_total(held), "components": components })
}

/// Each component with its gates, of which the largest comes first. Components of a kind are one row if they may hold
/// the same.
fn as_table(topology: &Topology, held: &[Held<'_>]) -> String {
    let has_bounds = held.iter().any(|held| held.component.memory().is_some());
    let numbers = ["MESSAGES", "WAITING", "IN FLIGHT", "LATCHED", "TOTAL", "BOUND"];
    let numbers = if has_bounds { &numbers[..] } else { &numbers[..5] };
    let mut table = Table::with_headings(&["COMPONENT, GATE", "KIND"], numbers);
    for (group, first) in groups(held) {
        let name = match (group, first.kind) {
            (2.., Some(kind)) => format!("{} ({group} components)", kind.name()),
            _ => first.component.name().to_owned(),
        };
        let total = rounded(first.total());
        let total = if group > 1 { format!("{group} x {total}") } else { total };
        let bound = first.component.memory().map(text).unwrap_or_default();
        let parts: [fn(&GateMemory) -> u64; 3] = [GateMemory::waiting, |it| it.in_flight, |it| it.latched];
        let [waiting, in_flight, latched] = parts.map(|part| amount(first.sum(part)));
        table.row([name, String::new(), String::new(), waiting, in_flight, latched, total, bound]);
        let mut gates: Vec<&HeldByGate<'_>> = first.gates.iter().filter(|held| held.memory.total() > 0).collect();
        gates.sort_by_key(|held| Reverse(held.memory.total()));
        gates.into_iter().for_each(|held| table.row(gate_row(held)));
    }
    table.row([&*format!("system {}", topology.system()), "", "", "", "", "", &*rounded(system_total(held))]);
    table.text()
}

fn gate_row(HeldByGate { gate, memory, .. }: &HeldByGate<'_>) -> [String; 7] {
    let messages = match memory.messages {
        0 => String::new(),
        messages => format!("{messages} x {}", rounded(memory.longest)),
    };
    [
        format!("  {}", gate.name()),
        gate.kind().word().to_owned(),
        messages,
        amount(memory.waiting()),
        amount(memory.in_flight),
        amount(memory.latched),
        rounded(memory.total()),
    ]
}

/// Nothing is an empty cell.
fn amount(bytes: u64) -> String {
    if bytes == 0 { String::new() } else { rounded(bytes) }
}

/// The components in the order of the file, with the number of those that the first stands for: all of its kind, if
/// they are alike.
fn groups<'h, 't>(held: &'h [Held<'t>]) -> Vec<(usize, &'h Held<'t>)> {
    let mut groups: Vec<(usize, &Held<'_>)> = Vec::new();
    let mut seen: HashMap<&str, Option<usize>> = HashMap::new();
    for of in held {
        let Some(kind) = of.kind.map(Kind::name) else {
            groups.push((1, of));
            continue;
        };
        let at = *seen.entry(kind).or_insert_with(|| {
            let at = groups.len();
            let mut others = held.iter().filter(|other| other.kind.is_some_and(|other| other.name() == kind));
            others.all(|other| of.is_like(other)).then(|| {
                groups.push((0, of));
                at
            })
        });
        match at {
            Some(at) => groups[at].0 += 1,
            None => groups.push((1, of)),
        }
    }
    groups
}

/// What most systems can improve, and what the figures are.
fn advice(topology: &Topology, held: &[Held<'_>]) -> Vec<String> {
    let is_default = |id: GateId| topology.gate(id).options().max_size == GateOptions::DEFAULT.max_size;
    let receives = |id: &GateId| matches!(topology.gate(*id).kind(), GateKind::Sub | GateKind::Pull);
    // The queues of a gate that sends are those of its receivers.
    let mut gates: Vec<GateId> = Vec::new();
    for held in held.iter().flat_map(|held| &held.gates).filter(|held| held.memory.messages > 0) {
        let peers = held.gate.connections().iter().map(|connection| topology.connection(*connection).peer_of(held.id));
        gates.extend(std::iter::once(held.id).chain(peers).filter(|gate| receives(gate) && is_default(*gate)));
    }
    gates.sort_unstable();
    gates.dedup();
    gates.sort_by_key(|gate| Reverse(topology.gate(*gate).options().queue));
    let mut lines = Vec::new();
    if let Some(first) = gates.first() {
        let names = listed(gates.iter().map(|gate| topology.gate_path(*gate)));
        let options = topology.gate(*first).options();
        let (queue, size) = (options.queue, text(options.max_size));
        let held = rounded(options.max_size.saturating_mul(queue.into()));
        let reason = match queue == GateOptions::DEFAULT.queue {
            true => format!("with the defaults, {queue} messages of {size}, {held} may wait at each end"),
            false => format!("with its default of {size}, {queue} messages may take {held} at each end"),
        };
        lines.push(format!("help: declare `max_size` at {names}: {reason}"));
    }
    lines.push("note: this is an upper bound on messages over sockets, without shared memory (`shm`)".to_owned());
    lines
}
