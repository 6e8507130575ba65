//! What is told of each component, gate and connection.

use super::text::{Kind, Labels};
use scl::runtime_dir::{ConnectionFigures, GateFigures};
use scl_observe::{Component, ProcessFigures, System};
use scl_plan::GatePlan;
use std::time::{SystemTime, UNIX_EPOCH};

/// The states of a component, as [`Activity::word`](scl_observe::Activity::word) has them.
pub(super) const STATES: [&str; 6] = ["stopped", "waiting", "ready", "running", "hangs", "dead"];

/// One figure of many things.
pub(super) struct Figure<T> {
    pub(super) name: &'static str,
    pub(super) kind: Kind,
    pub(super) help: &'static str,
    pub(super) value: fn(&T) -> Option<f64>,
}

/// A component as it is now.
pub(super) struct Seen {
    system: String,
    pub(super) component: Component,
    process: Option<ProcessFigures>,
}

/// A figure that only grows.
const fn counter<T>(name: &'static str, help: &'static str, value: fn(&T) -> Option<f64>) -> Figure<T> {
    Figure { name, kind: Kind::Counter, help, value }
}

/// A figure that rises and falls.
const fn gauge<T>(name: &'static str, help: &'static str, value: fn(&T) -> Option<f64>) -> Figure<T> {
    Figure { name, kind: Kind::Gauge, help, value }
}

pub(super) const COMPONENT: [Figure<Seen>; 4] = [
    gauge("scl_component_start_time_seconds", "When it was opened, since 1970.", |it| {
        since_1970(it.component.announcement.as_ref().filter(|_| it.component.is_running())?.started)
    }),
    gauge("scl_component_figures_time_seconds", "When it wrote its figures last, since 1970.", |it| {
        since_1970(it.component.stats.as_ref()?.written)
    }),
    counter("scl_component_cpu_seconds_total", "Processor time of its process, all threads together.", |it| {
        Some(it.process?.processor_time.as_secs_f64())
    }),
    gauge("scl_component_resident_memory_bytes", "Resident memory of its process.", |it| count(it.process?.memory)),
];

pub(super) const GATE: [Figure<GateFigures>; 14] = [
    counter("scl_gate_sent_messages_total", "Messages handed to peers, each peer counted.", |it| count(it.sent)),
    counter("scl_gate_received_messages_total", "Messages, requests or replies received.", |it| count(it.received)),
    counter("scl_gate_message_bytes_total", "Bytes of the messages sent or received.", |it| count(it.bytes)),
    counter("scl_gate_dropped_messages_total", "Dropped because a queue was full.", |it| {
        count(it.dropped_oldest.saturating_add(it.dropped_newest))
    }),
    counter("scl_gate_replaced_messages_total", "Replaced by a newer one in a queue of one.", |it| count(it.replaced)),
    counter("scl_gate_lost_messages_total", "On their way when their connection broke.", |it| count(it.lost)),
    counter("scl_gate_missed_messages_total", "Not sent or not received in the promised time.", |it| count(it.missed)),
    counter("scl_gate_expired_messages_total", "Dropped because they were too old.", |it| count(it.expired)),
    counter("scl_gate_rejected_messages_total", "Received but not usable.", |it| count(it.rejected)),
    counter("scl_gate_undecodable_messages_total", "Of the rejected: unreadable for the codec.", |it| {
        count(it.undecodable)
    }),
    counter("scl_gate_observer_dropped_messages_total", "Dropped for observers that read slowly.", |it| {
        count(it.dropped_for_observers)
    }),
    gauge("scl_gate_waiting_messages", "Messages in the program's queues.", |it| count(it.waiting)),
    gauge("scl_gate_connected_peers", "Peers that are connected.", |it| count(it.peers)),
    gauge("scl_gate_last_message_time_seconds", "When a message last moved, since 1970.", |it| {
        since_1970(it.last_activity?)
    }),
];

pub(super) const CONNECTION: [Figure<ConnectionFigures>; 6] = [
    gauge("scl_connection_connected", "1 if the peer is connected.", |it| count(u64::from(it.connected))),
    gauge("scl_connection_waiting_messages", "Messages in the queue for the peer.", |it| count(it.waiting)),
    gauge("scl_connection_in_flight_messages", "On their way, or not yet taken by the peer.", |it| count(it.in_flight)),
    counter("scl_connection_taken_messages_total", "Taken by the receiving program.", |it| count(it.taken)),
    counter("scl_connection_dropped_messages_total", "Dropped because the queue was full.", |it| count(it.dropped)),
    counter("scl_connection_lost_messages_total", "On their way when the connection broke.", |it| count(it.lost)),
];

impl Seen {
    /// All components of a system.
    pub(super) fn all(system: &System) -> impl Iterator<Item = Self> {
        system.components().into_iter().map(move |component| Self {
            system: system.name().to_owned(),
            process: component.process_figures(),
            component,
        })
    }

    pub(super) fn labels(&self) -> Labels<'_> {
        vec![("system", self.system.as_str().into()), ("component", self.component.name.as_str().into())]
    }

    /// Its gates that have figures.
    pub(super) fn gates(&self) -> impl Iterator<Item = (Labels<'_>, &GateFigures)> {
        self.planned_gates().map(|(labels, figures, _)| (labels, figures))
    }

    /// The connections of its gates.
    pub(super) fn connections(&self) -> impl Iterator<Item = (Labels<'_>, &ConnectionFigures)> {
        self.planned_gates().flat_map(|(labels, figures, plan)| {
            figures.connections.iter().zip(&plan.connections).map(move |(it, connection)| {
                let peer = format!("{}.{}", connection.peer_component, connection.peer_gate);
                ([labels.clone(), vec![("peer", peer.into())]].concat(), it)
            })
        })
    }

    fn planned_gates(&self) -> impl Iterator<Item = (Labels<'_>, &GateFigures, &GatePlan)> {
        let gates = self.component.gates().iter().enumerate();
        gates.filter_map(|(index, gate)| {
            let labels = [self.labels(), vec![("gate", gate.name.as_str().into())]].concat();
            Some((labels, self.component.figures(index)?, gate))
        })
    }
}

/// Counts above 2^53 lose their last digits, as in Prometheus itself.
fn count(count: u64) -> Option<f64> {
    Some(count as f64)
}

fn since_1970(time: SystemTime) -> Option<f64> {
    time.duration_since(UNIX_EPOCH).ok().map(|since| since.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::STATES;
    use scl_observe::Activity::{Dead, Hangs, Ready, Running, Stopped, Waiting};
    use std::time::Duration;

    #[test]
    fn each_state_is_told_of() {
        let words = [Stopped, Waiting, Ready, Running, Hangs(Duration::ZERO), Dead].map(|it| it.word());
        assert_eq!(words, STATES);
    }
}
