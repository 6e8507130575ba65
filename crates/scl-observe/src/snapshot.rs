//! A system at one moment: its components and gates, with rates since the previous snapshot. Only files are read, so it
//! costs the components nothing.

use crate::{Activity, Component, System, throughput};
use scl::runtime_dir::{ComponentStats, GateFigures};
use scl_plan::{GateKind, GatePlan};
use std::collections::{HashMap, VecDeque};
use std::time::{Duration, Instant, SystemTime};

/// Takes snapshots of a system.
#[derive(Debug)]
pub struct Watch {
    system: System,
    /// The shortest time over which rates are measured.
    window: Duration,
    before: HashMap<String, Before>,
}

/// What the previous snapshot saw of a component.
#[derive(Debug)]
struct Before {
    processor: Option<(u32, Instant, Duration)>,
    /// Its figures: the newest, and earlier ones back to the beginning of the window.
    stats: VecDeque<ComponentStats>,
    /// The latest rates, kept until the component has written its figures again.
    rates: Vec<Option<f64>>,
}

/// A system at one moment.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Snapshot {
    /// Its name.
    pub system: String,
    /// Its components, sorted by name.
    pub components: Vec<ComponentRow>,
    /// The gates of the components that run, by component, in the order of the topology file.
    pub gates: Vec<GateRow>,
}

/// One component.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentRow {
    /// Its name.
    pub name: String,
    /// What it is doing.
    pub activity: Activity,
    /// Its process, if it runs and is visible here.
    pub pid: Option<u32>,
    /// The share of one processor that the process used since the previous snapshot; 1 is a whole processor.
    pub processor: Option<f64>,
    /// The resident memory of the process in bytes.
    pub memory: Option<u64>,
    /// For how long it has been running.
    pub since: Option<Duration>,
    /// Its live parameters with their values, if it runs.
    pub parameters: Vec<(String, String)>,
}

/// One gate.
#[derive(Debug, Clone, PartialEq)]
pub struct GateRow {
    /// The component.
    pub component: String,
    /// The gate.
    pub gate: String,
    /// Its kind.
    pub kind: GateKind,
    /// What it carries, as in the topology file.
    pub payload: String,
    /// Its codec.
    pub codec: String,
    /// Messages per second since the previous snapshot: sent ones, each counted once for all peers, or received ones.
    pub rate: Option<f64>,
    /// What the component counted; `None` without figures.
    pub figures: Option<GateFigures>,
    /// Its connections.
    pub connections: Vec<ConnectionRow>,
}

/// One connection of a gate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConnectionRow {
    /// The gate at the other end, as `component.gate`.
    pub peer: String,
    /// Whether it is connected; `None` without figures.
    pub connected: Option<bool>,
}

impl Watch {
    /// Watches this system.
    pub fn new(system: System) -> Self {
        Self::with_window(system, Duration::ZERO)
    }

    /// Watches this system. Rates are measured over at least this time, even if snapshots follow each other faster: a
    /// gate that sends twice a second does so in every other snapshot of a quarter of a second.
    pub fn with_window(system: System, window: Duration) -> Self {
        Self { system, window, before: HashMap::new() }
    }

    /// Takes a snapshot.
    pub fn look(&mut self) -> Snapshot {
        let components = self.system.components();
        self.look_at(&components)
    }

    /// Takes a snapshot of components that were just read.
    pub fn look_at(&mut self, components: &[Component]) -> Snapshot {
        let (now, time) = (Instant::now(), SystemTime::now());
        let mut snapshot = Snapshot { system: self.system.name().to_owned(), ..Snapshot::default() };
        let mut seen = HashMap::new();
        for component in components {
            let before = self.before.remove(&component.name);
            let (row, processor) = component_row(component, before.as_ref(), now, time);
            let rates = rates(component, before.as_ref());
            if component.is_running() {
                snapshot.gates.extend(gate_rows(component, &rates));
            }
            snapshot.components.push(row);
            let stats = readings(before, component.stats.as_ref(), self.window);
            seen.insert(component.name.clone(), Before { processor, stats, rates });
        }
        self.before = seen;
        snapshot
    }
}

impl GateRow {
    /// `component.gate`.
    pub fn name(&self) -> String {
        format!("{}.{}", self.component, self.gate)
    }

    /// Messages dropped because a queue was full.
    pub fn dropped(&self) -> Option<u64> {
        self.figures.as_ref().map(|it| it.dropped_oldest.saturating_add(it.dropped_newest))
    }
}

type ProcessorTime = Option<(u32, Instant, Duration)>;

fn component_row(
    component: &Component,
    before: Option<&Before>,
    now: Instant,
    time: SystemTime,
) -> (ComponentRow, ProcessorTime) {
    let pid = component.process_id().filter(|_| component.is_running());
    let process = component.process_figures();
    let measured = pid.zip(process).map(|(pid, process)| (pid, now, process.processor_time));
    let processor = measured.zip(before.and_then(|before| before.processor)).and_then(|(after, before)| {
        let elapsed = after.1.duration_since(before.1).as_secs_f64();
        let used = after.2.checked_sub(before.2)?.as_secs_f64();
        (after.0 == before.0 && elapsed > 0.0).then(|| used / elapsed)
    });
    let started = component.announcement.as_ref().filter(|_| component.is_running()).map(|it| it.started);
    let row = ComponentRow {
        name: component.name.clone(),
        activity: component.activity(time),
        pid,
        processor,
        memory: process.map(|process| process.memory),
        since: started.and_then(|started| time.duration_since(started).ok()),
        parameters: if component.is_running() { live_parameters(component) } else { Vec::new() },
    };
    (row, measured)
}

fn live_parameters(component: &Component) -> Vec<(String, String)> {
    let live = component.parameters().filter(|(plan, _)| plan.live);
    live.filter_map(|(plan, value)| Some((plan.name.to_string(), value?.to_owned()))).collect()
}

fn gate_rows(component: &Component, rates: &[Option<f64>]) -> Vec<GateRow> {
    let gates = component.gates().iter().enumerate();
    let row = |(index, gate): (usize, &GatePlan)| {
        let figures = component.figures(index).cloned();
        let connections = gate.connections.iter().enumerate();
        let connections = connections.map(|(index, connection)| ConnectionRow {
            peer: format!("{}.{}", connection.peer_component, connection.peer_gate),
            connected: figures.as_ref().and_then(|it| it.connections.get(index)).map(|it| it.connected),
        });
        GateRow {
            component: component.name.clone(),
            gate: gate.name.clone(),
            kind: gate.kind,
            payload: gate.payload.to_string(),
            codec: gate.codec.clone(),
            rate: rates.get(index).copied().flatten(),
            connections: connections.collect(),
            figures,
        }
    };
    gates.map(row).collect()
}

/// The readings that the next rates are measured from: the newest, and before it the latest that is as old as the
/// window.
fn readings(before: Option<Before>, newest: Option<&ComponentStats>, window: Duration) -> VecDeque<ComponentStats> {
    let Some(newest) = newest else { return VecDeque::new() };
    let mut readings = before.map(|before| before.stats).unwrap_or_default();
    readings.retain(|reading| reading.started == newest.started && reading.written < newest.written);
    readings.push_back(newest.clone());
    let is_old =
        |reading: &ComponentStats| newest.written.duration_since(reading.written).is_ok_and(|age| age >= window);
    while readings.get(1).is_some_and(is_old) {
        readings.pop_front();
    }
    readings
}

/// Messages per second of each gate; the previous ones if the figures were not written since.
fn rates(component: &Component, before: Option<&Before>) -> Vec<Option<f64>> {
    let (Some(plan), Some(stats), Some(before)) = (component.plan(), &component.stats, before) else {
        return Vec::new();
    };
    let Some(old) = before.stats.front().filter(|old| old.started == stats.started) else { return Vec::new() };
    match throughput::rates(plan, old, stats) {
        Some(rates) => rates.iter().map(|rate| Some(rate.messages)).collect(),
        None => before.rates.clone(),
    }
}
