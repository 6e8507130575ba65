//! The diagram of a system: its components as blocks, its gates as rows, its groups as frames.

use crate::diagram::{Block, Diagram, Edge, End, Frame, Row};
use crate::live::{Figures, Flow, State};
use crate::stacks::Stacks;
use scl_plan::{GateKind, GatePlan, Payload, SystemPlan};
use scl_terminal::shorten;
use std::collections::{HashMap, HashSet};

/// With more components than this, a diagram shows no gates unless they are asked for.
const MOST_WITH_GATES: usize = 12;
/// The fewest components of which one can have a gate for all the others.
const FEWEST_FOR_EVERYONE: usize = 4;
/// Longest text of a row's types, in columns.
const LONGEST_TYPES: usize = 20;

/// What the blocks show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// One box for each component, and one edge for all connections of two components.
    Components,
    /// All gates and all connections.
    Gates,
}

/// What a diagram shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// `None`: gates for up to twelve components, otherwise components only.
    pub detail: Option<Detail>,
    /// Whether it shows gates that are connected with every other component, such as the log's.
    pub everyone: bool,
    /// Whether three or more components of a kind, in the same group, are one block.
    pub stacks: bool,
    /// Whether there is room for what a running system does.
    pub live: bool,
}

/// The diagram of a system.
#[must_use]
pub fn diagram_of(system: &SystemPlan, options: Options) -> Diagram {
    let stacks = if options.stacks { Stacks::of(system) } else { Stacks::default() };
    let detail = options.detail.unwrap_or(match stacks.blocks(system.components.len()) {
        0..=MOST_WITH_GATES => Detail::Gates,
        _ => Detail::Components,
    });
    let hubs = if options.everyone { Vec::new() } else { gates_of_everyone(system) };
    let hidden: HashSet<(&str, &str)> = hubs.iter().copied().collect();
    let mut diagram = Diagram { title: system.system.clone(), ..Diagram::default() };
    let mut frames = HashMap::new();
    let mut ends = HashMap::new();
    let mut blocks_of_stacks = HashMap::new();
    for plan in &system.components {
        let stack = stacks.stack_of(&plan.component);
        if let Some(&index) = stack.and_then(|stack| blocks_of_stacks.get(&stack)) {
            // It has the same gates as the first.
            let block: &mut Block = &mut diagram.blocks[index];
            block.others.push(plan.component.clone());
            for gate in &plan.gates {
                let row = block.rows.iter().position(|row| row.name == gate.name);
                if row.is_some() || detail == Detail::Components && !is_hidden(&plan.component, gate, &hidden) {
                    ends.insert((plan.component.as_str(), gate.name.as_str()), End { block: index, row });
                }
            }
            continue;
        }
        let (group, title) = plan.component.rsplit_once('.').unwrap_or(("", &plan.component));
        let frame = (!group.is_empty()).then(|| frame_of(&mut diagram.frames, &mut frames, group));
        let mut rows = Vec::new();
        for gate in plan.gates.iter().filter(|gate| !is_hidden(&plan.component, gate, &hidden)) {
            let row = (detail == Detail::Gates).then_some(rows.len());
            ends.insert((plan.component.as_str(), gate.name.as_str()), End { block: diagram.blocks.len(), row });
            if row.is_some() {
                rows.push(Row {
                    name: gate.name.clone(),
                    kind: gate.kind.word().to_owned(),
                    types: shorten(&short_types(&gate.payload), LONGEST_TYPES),
                    figures: options.live.then(Figures::default),
                });
            }
        }
        let state = options.live.then_some(State::Stopped);
        let title = stack.map_or(title, |stack| stacks.title(stack)).to_owned();
        blocks_of_stacks.extend(stack.map(|stack| (stack, diagram.blocks.len())));
        diagram.blocks.push(Block { name: plan.component.clone(), others: Vec::new(), title, rows, frame, state });
    }
    diagram.edges = edges(system, &ends);
    if options.live {
        diagram.edges.iter_mut().for_each(|edge| edge.flow = Some(Flow::NotConnected));
    }
    if detail == Detail::Components || !blocks_of_stacks.is_empty() {
        diagram.edges = merged(diagram.edges);
    }
    diagram.notes = hubs
        .iter()
        .map(|(component, gate)| format!("not drawn: {component}.{gate}, connected with every other component"))
        .collect();
    diagram
}

/// The frame of a group, in which those of its groups are.
fn frame_of<'n>(frames: &mut Vec<Frame>, known: &mut HashMap<&'n str, usize>, group: &'n str) -> usize {
    if let Some(&frame) = known.get(group) {
        return frame;
    }
    let (parent, title) = match group.rsplit_once('.') {
        Some((parent, title)) => (Some(frame_of(frames, known, parent)), title),
        None => (None, group),
    };
    frames.push(Frame { title: title.to_owned(), parent });
    known.insert(group, frames.len() - 1);
    frames.len() - 1
}

/// The gates that are connected with every other component, each with its component.
fn gates_of_everyone(system: &SystemPlan) -> Vec<(&str, &str)> {
    let components = system.components.len();
    let gates = system.components.iter().flat_map(|plan| plan.gates.iter().map(move |gate| (plan, gate)));
    let of_everyone = gates.filter(|(plan, gate)| {
        let peers = gate.connections.iter().map(|it| it.peer_component.as_str());
        let peers: HashSet<&str> = peers.filter(|peer| *peer != plan.component).collect();
        components >= FEWEST_FOR_EVERYONE && peers.len() == components - 1
    });
    of_everyone.map(|(plan, gate)| (plan.component.as_str(), gate.name.as_str())).collect()
}

/// Whether a gate is one of those, or has connections with those only.
fn is_hidden(component: &str, gate: &GatePlan, hubs: &HashSet<(&str, &str)>) -> bool {
    let mut peers = gate.connections.iter().map(|it| (it.peer_component.as_str(), it.peer_gate.as_str()));
    hubs.contains(&(component, gate.name.as_str()))
        || !gate.connections.is_empty() && peers.all(|peer| hubs.contains(&peer))
}

fn edges(system: &SystemPlan, ends: &HashMap<(&str, &str), End>) -> Vec<Edge> {
    let mut edges = Vec::new();
    for plan in &system.components {
        for gate in plan.gates.iter().filter(|gate| gate.kind.is_source()) {
            for connection in &gate.connections {
                let from = ends.get(&(plan.component.as_str(), gate.name.as_str()));
                let to = ends.get(&(connection.peer_component.as_str(), connection.peer_gate.as_str()));
                let (Some(&from), Some(&to)) = (from, to) else { continue };
                let asks = gate.kind == GateKind::Req;
                let (component, peer) = (&plan.component, &connection.peer_component);
                let arrow = if asks { '⇄' } else { '→' };
                let (name, peer_gate, payload) = (&gate.name, &connection.peer_gate, &gate.payload);
                let detail = format!("{component}.{name} {arrow} {peer}.{peer_gate}: {payload}");
                let connections = vec![(format!("{component}.{name}"), format!("{peer}.{peer_gate}"))];
                edges.push(Edge { from, to, both_ways: asks, asks, details: vec![detail], connections, flow: None });
            }
        }
    }
    edges
}

/// One edge for all edges between the same two blocks.
fn merged(edges: Vec<Edge>) -> Vec<Edge> {
    let mut merged: Vec<Edge> = Vec::new();
    let mut known: HashMap<(End, End), usize> = HashMap::new();
    for edge in edges {
        let ends = (edge.from.min(edge.to), edge.from.max(edge.to));
        match known.get(&ends).map(|&index| &mut merged[index]) {
            Some(into) => {
                into.both_ways |= edge.both_ways || into.from != edge.from;
                into.asks &= edge.asks;
                into.details.extend(edge.details);
                into.connections.extend(edge.connections);
            }
            None => {
                known.insert(ends, merged.len());
                merged.push(edge);
            }
        }
    }
    merged
}

/// The types of a gate's messages without their packages: `Measurement`, `Command → Status`; empty for bytes.
fn short_types(payload: &Payload) -> String {
    let types = payload.types().map(|name| name.rsplit_once('.').map_or(name, |(_, last)| last));
    types.collect::<Vec<_>>().join(" → ")
}
