//! What the columns of `scl top` contain, and the order of its rows.

use super::Order;
use scl_observe::{ComponentRow, GateRow, Snapshot};
use scl_terminal::{age_text, bytes_text, escape, three_digits};
use serde_json::{Value, json};
use std::cmp::Reverse;
use std::collections::BTreeMap;

pub(super) const COMPONENT_COLUMNS: [&str; 6] = ["COMPONENT", "STATE", "PID", "CPU", "MEM", "SINCE"];

pub(super) const GATE_COLUMNS: [&str; 9] =
    ["GATE", "KIND", "RATE", "SENT", "RECEIVED", "WAIT", "DROP", "LOST", "PEERS"];

/// Placeholder for an unknown value.
const UNKNOWN: &str = "-";

/// Both tables begin with this many columns of words; numbers follow.
pub(super) const TEXT_COLUMNS: usize = 2;

pub(super) fn component_cells(row: &ComponentRow) -> [String; 6] {
    let or_unknown = |text: Option<String>| text.unwrap_or_else(|| UNKNOWN.to_owned());
    [
        row.name.clone(),
        row.activity.word().to_owned(),
        or_unknown(row.pid.map(|pid| pid.to_string())),
        or_unknown(row.processor.map(|part| format!("{:.1}%", part * 100.0))),
        or_unknown(row.memory.map(|bytes| bytes_text(bytes as f64))),
        or_unknown(row.since.map(age_text)),
    ]
}

pub(super) fn gate_cells(row: &GateRow) -> [String; 9] {
    let count = |number: Option<u64>| number.map_or_else(|| UNKNOWN.to_owned(), count_text);
    let figures = row.figures.as_ref();
    [
        row.name(),
        row.kind.word().to_owned(),
        row.rate.map_or_else(|| UNKNOWN.to_owned(), three_digits),
        count(figures.map(|it| it.sent)),
        count(figures.map(|it| it.received)),
        count(figures.map(|it| it.waiting)),
        count(row.dropped()),
        count(figures.map(|it| it.lost)),
        format!("{}/{}", count(figures.map(|it| it.peers)), row.connections.len()),
    ]
}

/// A live parameter of a component, and its value.
pub(super) fn parameter_cells(row: &ComponentRow) -> impl Iterator<Item = [String; 2]> {
    row.parameters.iter().map(|(name, value)| [format!("{}.{name}", row.name), escape(value).into_owned()])
}

/// A count of at most seven characters.
fn count_text(count: u64) -> String {
    match count {
        0..10_000_000 => count.to_string(),
        10_000_000..10_000_000_000 => format!("{}M", count / 1_000_000),
        _ => format!("{}G", count / 1_000_000_000),
    }
}

/// Sorts the rows. Rows that compare equal keep their order.
pub(super) fn sort(snapshot: &mut Snapshot, order: Order) {
    let Snapshot { components, gates, .. } = snapshot;
    // Sort by integers, because floats have no total order; thousandths are precise enough.
    let thousandths = |number: Option<f64>| Reverse(number.map(|number| (number * 1000.0) as u64));
    match order {
        Order::Name => {}
        Order::Cpu => components.sort_by_key(|row| thousandths(row.processor)),
        Order::Memory => components.sort_by_key(|row| Reverse(row.memory)),
        Order::Rate => gates.sort_by_key(|row| thousandths(row.rate)),
        Order::Waiting => gates.sort_by_key(|row| Reverse(row.figures.as_ref().map(|it| it.waiting))),
        Order::Dropped => gates.sort_by_key(|row| Reverse(row.dropped())),
    }
}

pub(super) fn to_json(snapshot: &Snapshot) -> Value {
    json!({
        "system": snapshot.system,
        "components": snapshot.components.iter().map(component_json).collect::<Vec<_>>(),
        "gates": snapshot.gates.iter().map(gate_json).collect::<Vec<_>>(),
    })
}

fn component_json(row: &ComponentRow) -> Value {
    json!({
        "component": row.name,
        "state": row.activity.word(),
        "pid": row.pid,
        "cpu_percent": row.processor.map(|part| part * 100.0),
        "memory_bytes": row.memory,
        "since_seconds": row.since.map(|since| since.as_secs_f64()),
        "parameters": row.parameters.iter().cloned().collect::<BTreeMap<_, _>>(),
    })
}

fn gate_json(row: &GateRow) -> Value {
    let figures = row.figures.as_ref();
    json!({
        "gate": row.name(),
        "kind": row.kind.word(),
        "payload": row.payload,
        "codec": row.codec,
        "rate_hz": row.rate,
        "sent": figures.map(|it| it.sent),
        "received": figures.map(|it| it.received),
        "waiting": figures.map(|it| it.waiting),
        "replaced": figures.map(|it| it.replaced),
        "dropped": row.dropped(),
        "lost": figures.map(|it| it.lost),
        "rejected": figures.map(|it| it.rejected),
        "undecodable": figures.map(|it| it.undecodable),
        "missed": figures.map(|it| it.missed),
        "expired": figures.map(|it| it.expired),
        "bytes": figures.map(|it| it.bytes),
        "connected": figures.map(|it| it.peers),
        "peers": row.connections.iter().map(|it| json!({"gate": it.peer, "connected": it.connected})).collect::<Vec<_>>(),
    })
}
