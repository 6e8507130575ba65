//! What a snapshot says about the parts of a diagram: the states of components, the figures of gates, what flows
//! through connections.

use scl_diagram::{Diagram, Edge, Figures, Flow, State};
use scl_observe::{Activity, GateRow, Snapshot};
use scl_plan::SystemPlan;
use std::collections::HashMap;
use std::time::{Duration, Instant};

/// For how long a gate counts as dropping after it has dropped a message.
const RECENT: Duration = Duration::from_secs(3);

/// What is remembered from one snapshot to the next: when the counts of each gate last rose.
#[derive(Default)]
pub(crate) struct Troubles {
    gates: HashMap<String, Counts>,
}

/// The counts of a gate that should stay as they are.
#[derive(Debug, Clone, Default)]
pub(crate) struct Counts {
    pub(crate) dropped: u64,
    pub(crate) missed: u64,
    /// By connection.
    connections: Vec<u64>,
    dropping: Option<Instant>,
    missing: Option<Instant>,
    dropping_to: Vec<Option<Instant>>,
}

impl Troubles {
    /// Learns the counts of a snapshot.
    pub(crate) fn learn(&mut self, snapshot: &Snapshot, now: Instant) {
        let mut gates = HashMap::new();
        for row in &snapshot.gates {
            let name = row.name();
            let Some(figures) = &row.figures else { continue };
            let before = self.gates.remove(&name);
            let connections: Vec<u64> = figures.connections.iter().map(|it| it.dropped).collect();
            let (dropped, missed) = (row.dropped().unwrap_or(0), figures.missed);
            // Without a snapshot before, nobody knows when it was.
            let before = before.unwrap_or_else(|| Counts {
                dropped,
                missed,
                connections: connections.clone(),
                dropping_to: vec![None; connections.len()],
                ..Counts::default()
            });
            let rose = |then: u64, count: u64, last: Option<Instant>| if count > then { Some(now) } else { last };
            let to = connections.iter().enumerate().map(|(index, &count)| {
                let then = before.connections.get(index).copied().unwrap_or(0);
                rose(then, count, before.dropping_to.get(index).copied().flatten())
            });
            let dropping_to = to.collect();
            let dropping = rose(before.dropped, dropped, before.dropping);
            let missing = rose(before.missed, missed, before.missing);
            gates.insert(name, Counts { dropped, missed, connections, dropping, missing, dropping_to });
        }
        self.gates = gates;
    }

    /// The counts of a gate.
    pub(crate) fn of(&self, gate: &str) -> Option<&Counts> {
        self.gates.get(gate)
    }
}

impl Counts {
    pub(crate) fn is_dropping(&self, now: Instant) -> bool {
        is_recent(self.dropping, now)
    }

    pub(crate) fn is_missing(&self, now: Instant) -> bool {
        is_recent(self.missing, now)
    }

    fn is_dropping_to(&self, connection: usize, now: Instant) -> bool {
        is_recent(self.dropping_to.get(connection).copied().flatten(), now)
    }
}

fn is_recent(last: Option<Instant>, now: Instant) -> bool {
    last.is_some_and(|last| now.saturating_duration_since(last) < RECENT)
}

/// Writes what a snapshot says into a diagram of the same system.
pub(crate) fn enliven(
    diagram: &mut Diagram,
    plans: &SystemPlan,
    snapshot: &Snapshot,
    troubles: &Troubles,
    now: Instant,
) {
    let states: HashMap<&str, Activity> =
        snapshot.components.iter().map(|row| (row.name.as_str(), row.activity)).collect();
    let rows: HashMap<String, &GateRow> = snapshot.gates.iter().map(|row| (row.name(), row)).collect();
    for block in &mut diagram.blocks {
        // Of a stack, the worst.
        let of_components = block.components().map(|component| state_of(states.get(component).copied()));
        block.state = of_components.max();
        let figures = |gate: &str| {
            let of_component = |component: &str| {
                let name = format!("{component}.{gate}");
                figures_of(plans, component, rows.get(&name).copied(), troubles.of(&name), now)
            };
            block.components().map(of_component).reduce(together).unwrap_or_default()
        };
        let of_rows: Vec<Figures> = block.rows.iter().map(|row| figures(&row.name)).collect();
        block.rows.iter_mut().zip(of_rows).for_each(|(row, figures)| row.figures = Some(figures));
    }
    for edge in &mut diagram.edges {
        edge.flow = Some(flow_of(edge, &rows, troubles, now));
    }
}

fn state_of(activity: Option<Activity>) -> State {
    match activity {
        None | Some(Activity::Stopped) => State::Stopped,
        Some(Activity::Running | Activity::Ready) => State::Running,
        Some(Activity::Waiting) => State::Waiting,
        Some(Activity::Hangs(_)) => State::Hanging,
        Some(Activity::Dead) => State::Dead,
    }
}

/// The figures of a gate of a component, which has a row if it runs.
pub(crate) fn figures_of(
    plans: &SystemPlan,
    component: &str,
    row: Option<&GateRow>,
    counts: Option<&Counts>,
    now: Instant,
) -> Figures {
    let Some(row) = row else { return Figures::default() };
    let waiting = row.figures.as_ref().map_or(0, |figures| figures.waiting);
    let gate = plans.component(component).ok().and_then(|plan| plan.gate(&row.gate));
    let room = gate.map_or(0, |gate| {
        let queues: u64 = gate.connections.iter().map(|it| u64::from(it.queue)).sum();
        if row.kind.is_source() { queues } else { u64::from(gate.options.queue) }
    });
    let trouble = counts.map_or_else(String::new, |counts| {
        let dropped = (counts.dropped > 0).then(|| format!("{} dropped", short_count(counts.dropped)));
        let missed = (counts.missed > 0).then(|| format!("{} missed", short_count(counts.missed)));
        let first = if counts.is_missing(now) { missed.clone().or(dropped) } else { dropped.or(missed) };
        first.unwrap_or_default()
    });
    Figures {
        rate: row.rate.map_or_else(String::new, short_rate),
        per_second: row.rate.unwrap_or(0.0),
        // A queue of one has the newest value, and is full most of the time.
        filled: if room <= 1 { 0.0 } else { (waiting as f64 / room as f64).min(1.0) },
        is_bad: counts.is_some_and(|counts| counts.is_dropping(now) || counts.is_missing(now)),
        trouble,
    }
}

/// The figures of the same gate of two components: all messages, and the worst of the rest.
fn together(one: Figures, other: Figures) -> Figures {
    let per_second = one.per_second + other.per_second;
    let is_worse = (other.is_bad && !one.is_bad) || one.trouble.is_empty();
    Figures {
        rate: short_rate(per_second),
        per_second,
        filled: one.filled.max(other.filled),
        is_bad: one.is_bad || other.is_bad,
        trouble: if is_worse { other.trouble } else { one.trouble },
    }
}

/// What flows through the connections of an edge: the worst of them, and the sum of their rates.
fn flow_of(edge: &Edge, rows: &HashMap<String, &GateRow>, troubles: &Troubles, now: Instant) -> Flow {
    let (mut connected, mut dropping, mut per_second) = (true, false, 0.0);
    for (from, to) in &edge.connections {
        let Some(row) = rows.get(from) else {
            connected = false;
            continue;
        };
        let index = row.connections.iter().position(|connection| connection.peer == *to);
        let is_connected = index.and_then(|index| row.connections[index].connected);
        connected &= is_connected != Some(false);
        dropping |= index.is_some_and(|index| troubles.of(from).is_some_and(|it| it.is_dropping_to(index, now)));
        // Recordings have no figures of senders that share a receiver.
        let rate = row.rate.or_else(|| rows.get(to)?.rate);
        per_second += rate.filter(|_| is_connected == Some(true)).unwrap_or(0.0);
    }
    match (dropping, connected) {
        (true, _) => Flow::Dropping,
        (false, false) => Flow::NotConnected,
        (false, true) if per_second > 0.0 => Flow::Messages(per_second),
        (false, true) => Flow::Idle,
    }
}

/// `300/s`, `1.5k/s`, `0.25/s`; nothing for none.
fn short_rate(rate: f64) -> String {
    match rate {
        0.0 => String::new(),
        rate if rate < 1.0 => format!("{rate:.2}/s"),
        rate if rate < 9.95 => format!("{rate:.1}/s"),
        rate => format!("{}/s", short_count(rate.round() as u64)),
    }
}

/// `999`, `1.5k`, `23k`, `4M`.
fn short_count(count: u64) -> String {
    match count {
        0..=999 => count.to_string(),
        1_000..=9_999 => format!("{:.1}k", count as f64 / 1e3),
        10_000..=999_999 => format!("{}k", count / 1_000),
        _ => format!("{}M", count / 1_000_000),
    }
}

#[cfg(test)]
mod tests {
    use super::{RECENT, Troubles, short_count, short_rate};
    use scl::runtime_dir::{ConnectionFigures, GateFigures};
    use scl_observe::{GateRow, Snapshot};
    use scl_plan::GateKind;
    use std::time::Instant;

    /// A snapshot of one gate, which has dropped this many messages.
    fn snapshot(dropped: u64) -> Snapshot {
        let (mut connection, mut figures) = (ConnectionFigures::default(), GateFigures::default());
        connection.dropped = dropped;
        figures.dropped_oldest = dropped;
        figures.connections = vec![connection];
        let gate = GateRow {
            component: "sensor".into(),
            gate: "values".into(),
            kind: GateKind::Pub,
            payload: String::new(),
            codec: String::new(),
            rate: None,
            figures: Some(figures),
            connections: Vec::new(),
        };
        Snapshot { gates: vec![gate], ..Snapshot::default() }
    }

    #[test]
    fn a_gate_is_dropping_for_a_while_after_each_drop() {
        let (mut troubles, start) = (Troubles::default(), Instant::now());
        let mut is_dropping = |dropped: u64, after: u32| {
            let now = start + RECENT * after / 2;
            troubles.learn(&snapshot(dropped), now);
            let counts = troubles.of("sensor.values").unwrap();
            assert_eq!(counts.is_dropping(now), counts.is_dropping_to(0, now));
            counts.is_dropping(now)
        };
        // What was dropped before the first look may be long ago.
        assert!(!is_dropping(5, 0));
        assert!(is_dropping(6, 1));
        assert!(is_dropping(6, 2));
        assert!(!is_dropping(6, 3));
        assert!(is_dropping(7, 4));
        // The component was restarted, and counts from 0.
        assert!(!is_dropping(0, 6));
        assert!(is_dropping(1, 7));
    }

    #[test]
    fn rates_and_counts_are_short() {
        let rates = [0.0, 0.25, 1.0, 9.99, 300.2, 1_000.0, 1_532.0, 23_456.0, 4_000_000.0];
        let expected = ["", "0.25/s", "1.0/s", "10/s", "300/s", "1.0k/s", "1.5k/s", "23k/s", "4M/s"];
        assert_eq!(rates.map(short_rate), expected);
        assert_eq!([0, 999, 1_000, 9_999, 10_000].map(short_count), ["0", "999", "1.0k", "10.0k", "10k"]);
    }
}
