//! The messages that gates with a `rate` or a `deadline` have missed during the recording.

use super::plans::Plans;
use crate::format::{MissedGate, MissedPeer};
use bytes::Bytes;
use scl::runtime_dir::{ComponentStats, GateFigures};
use scl_observe::System;
use scl_plan::{GatePlan, Plan};
use std::collections::BTreeMap;
use std::iter::repeat;
use std::time::SystemTime;

/// The counts since the recording began.
#[derive(Debug)]
pub(crate) struct Missed {
    began: SystemTime,
    /// What each component had counted when it was last looked at, and when it was started.
    before: BTreeMap<String, (SystemTime, Vec<Counts>)>,
    /// By `component.gate`.
    gates: BTreeMap<String, MissedGate>,
}

/// What a gate has counted: of all its peers, and of each.
#[derive(Debug, Clone, Default)]
struct Counts {
    all: u64,
    peers: Vec<u64>,
}

impl Missed {
    /// Begins to count now.
    pub(crate) fn start(system: &System, plans: &Plans) -> Self {
        let mut missed = Self { began: SystemTime::now(), before: BTreeMap::new(), gates: BTreeMap::new() };
        let _nothing_yet = missed.update(system, plans);
        missed
    }

    /// Looks at the components again; returns all counts as JSON if one has changed.
    pub(crate) fn update(&mut self, system: &System, plans: &Plans) -> Option<Bytes> {
        let mut has_changed = false;
        for plan in plans.with_time() {
            if let Some(stats) = ComponentStats::read(system.dir(), &plan.component) {
                has_changed |= self.add(plan, stats.started, &stats.gates);
            }
        }
        let gates: Vec<&MissedGate> = self.gates.values().collect();
        has_changed.then(|| serde_json::to_vec(&gates).unwrap_or_default().into())
    }

    /// Adds what a component has counted since it was last looked at. Returns true if it has missed messages.
    fn add(&mut self, plan: &Plan, started: SystemTime, gates: &[GateFigures]) -> bool {
        if gates.len() != plan.gates.len() {
            // Another build has started a moment ago; its plan is read soon.
            return false;
        }
        let now: Vec<Counts> = gates
            .iter()
            .map(|gate| {
                let peers = gate.connections.iter().map(|connection| connection.missed).collect();
                Counts { all: gate.missed, peers }
            })
            .collect();
        let before = self.before.insert(plan.component.clone(), (started, now.clone()));
        // A process that was started during the recording counts from 0 on.
        let before = match before.filter(|(known, _)| *known == started) {
            Some((_, before)) => before,
            None if started >= self.began => vec![Counts::default(); now.len()],
            None => now.clone(),
        };
        let mut has_changed = false;
        for ((gate, now), before) in plan.gates.iter().zip(&now).zip(&before) {
            debug_assert!(now.all >= before.all, "counts only rise");
            let added = now.all.saturating_sub(before.all);
            if added == 0 {
                continue;
            }
            has_changed = true;
            let missed = self.gates.entry(path(plan, gate)).or_insert_with(|| none_missed(plan, gate));
            missed.missed += added;
            // A process that has just started had counted nothing of any peer.
            let before = before.peers.iter().chain(repeat(&0));
            for ((peer, now), before) in missed.peers.iter_mut().zip(&now.peers).zip(before) {
                peer.missed += now.saturating_sub(*before);
            }
        }
        has_changed
    }
}

fn path(plan: &Plan, gate: &GatePlan) -> String {
    format!("{}.{}", plan.component, gate.name)
}

fn none_missed(plan: &Plan, gate: &GatePlan) -> MissedGate {
    // A gate that listens cannot tell its peers apart, and one that sends has missed the same of all.
    let tells_apart = gate.endpoint.is_none() && !gate.kind.is_source();
    let peers = gate.connections.iter().filter(|_| tells_apart);
    let peer = |component: &str, gate: &str| MissedPeer { gate: format!("{component}.{gate}"), missed: 0 };
    MissedGate {
        gate: path(plan, gate),
        missed: 0,
        peers: peers.map(|connection| peer(&connection.peer_component, &connection.peer_gate)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scl::runtime_dir::ConnectionFigures;
    use scl_plan::SystemPlan;
    use std::time::Duration;

    fn plan() -> Plan {
        let text = r#"{"version": 1, "system": "rover", "components": [{"name": "controller", "declared_at": "", "schema": null,
            "gates": [{"name": "sensor", "kind": "sub", "payload": null, "codec": "raw", "declared_at": "", "endpoint": null,
                "tap": null, "contract": "aaaa", "deadline_ns": 1000000, "connections": [
                    {"peer_component": "left", "peer_gate": "out", "endpoint": "e", "contract": "c", "required": true,
                     "queue": 1, "when_full": "wait", "max_size": 1},
                    {"peer_component": "right", "peer_gate": "out", "endpoint": "e", "contract": "c", "required": true,
                     "queue": 1, "when_full": "wait", "max_size": 1}]}]}], "schemas": {}}"#;
        SystemPlan::from_json(text).unwrap().components.remove(0)
    }

    fn figures(peers: [u64; 2]) -> [GateFigures; 1] {
        let connections = peers.map(|missed| {
            let mut figures = ConnectionFigures::default();
            figures.missed = missed;
            figures
        });
        let mut gate = GateFigures::default();
        (gate.missed, gate.connections) = (peers.iter().sum(), connections.to_vec());
        [gate]
    }

    #[test]
    fn what_was_missed_before_the_recording_does_not_count() {
        let (plan, now) = (plan(), SystemTime::now());
        let mut missed = Missed { began: now, before: BTreeMap::new(), gates: BTreeMap::new() };
        let (earlier, later) = (now - Duration::from_secs(1), now + Duration::from_secs(1));
        assert!(!missed.add(&plan, earlier, &figures([5, 7])), "they are older than the recording");
        assert!(!missed.add(&plan, earlier, &figures([5, 7])));
        assert!(missed.add(&plan, earlier, &figures([6, 9])));
        // It was started again, and has counted before it was looked at.
        assert!(missed.add(&plan, later, &figures([0, 1])));
        assert!(!missed.add(&plan, later, &figures([0, 1])));
        let peer = |gate: &str, missed| MissedPeer { gate: gate.to_owned(), missed };
        let expected = MissedGate {
            gate: "controller.sensor".to_owned(),
            missed: 4,
            peers: vec![peer("left.out", 1), peer("right.out", 3)],
        };
        assert_eq!(missed.gates.into_values().collect::<Vec<_>>(), [expected]);
    }
}
