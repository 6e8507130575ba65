//! How much passes a gate per second, from two readings of a component's figures.

use crate::system::System;
use scl::runtime_dir::{ComponentStats, GateFigures};
use scl_plan::{GateKind, Plan};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The pause between two attempts to read newer figures.
const PAUSE: Duration = Duration::from_millis(20);

/// What passes a gate per second.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GateRate {
    /// Messages; at `req` and `rep` gates, calls.
    pub messages: f64,
    /// Bytes of messages, for each peer of a `pub` gate.
    pub bytes: f64,
}

/// Number of messages that passed a gate: at a `pub` gate those that were published, however many subscribers there
/// are; at `req` and `rep` gates the requests.
pub fn message_count(kind: GateKind, figures: &GateFigures) -> u64 {
    match kind {
        GateKind::Pub => {
            let connections = figures.connections.iter();
            connections.map(|it| it.published() - it.latched).max().unwrap_or(0)
        }
        GateKind::Push | GateKind::Req => figures.sent,
        GateKind::Sub | GateKind::Pull | GateKind::Rep => figures.received,
    }
}

/// The rates of a component's gates between two readings, in the plan's order. `None` if the readings are not of the
/// same run and plan, or the later one is not newer.
pub fn rates(plan: &Plan, earlier: &ComponentStats, later: &ComponentStats) -> Option<Vec<GateRate>> {
    let seconds = later.written.duration_since(earlier.written).ok()?.as_secs_f64();
    let same_run = earlier.started == later.started && earlier.pid == later.pid;
    let same_plan = [earlier, later].iter().all(|stats| stats.gates.len() == plan.gates.len());
    if !same_run || !same_plan || seconds <= 0.0 {
        return None;
    }
    let per_second = |earlier: u64, later: u64| later.saturating_sub(earlier) as f64 / seconds;
    let rate = |kind, earlier: &GateFigures, later: &GateFigures| GateRate {
        messages: per_second(message_count(kind, earlier), message_count(kind, later)),
        bytes: per_second(earlier.bytes, later.bytes),
    };
    let readings = earlier.gates.iter().zip(&later.gates);
    Some(plan.gates.iter().zip(readings).map(|(gate, (earlier, later))| rate(gate.kind, earlier, later)).collect())
}

impl System {
    /// Waits for figures of a component that are newer than these; `None` if there are none after `patience`. Blocks
    /// the thread.
    pub fn newer_stats(&self, component: &str, than: &ComponentStats, patience: Duration) -> Option<ComponentStats> {
        let start = Instant::now();
        loop {
            match ComponentStats::read(self.dir(), component) {
                Some(stats) if stats.written != than.written => return Some(stats),
                _ if start.elapsed() >= patience => return None,
                _ => sleep(PAUSE),
            }
        }
    }
}
