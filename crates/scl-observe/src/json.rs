//! Components and gates as JSON, the same for all commands.

use crate::component::Component;
use crate::peer::{Peer, peers};
use crate::process::ProcessFigures;
use crate::throughput::{GateRate, message_count};
use scl::runtime_dir::{ComponentProcess, ComponentState, ConnectionFigures, GateFigures};
use scl_plan::{GatePlan, Payload};
use scl_terminal::timestamp;
use serde_json::{Value, json};
use std::time::SystemTime;

impl Component {
    /// `running`, `dead` (killed or crashed) or `stopped`.
    pub fn state_word(&self) -> &'static str {
        match self.state {
            ComponentState::Running(_) => "running",
            ComponentState::Dead => "dead",
            ComponentState::Stopped => "stopped",
        }
    }

    /// The process that runs the component, if it is visible from here; for a dead component, the process that ran it.
    pub fn process_id(&self) -> Option<u32> {
        match self.state {
            ComponentState::Running(ComponentProcess::ThisProcess) => Some(std::process::id()),
            ComponentState::Running(ComponentProcess::Process(id)) => Some(id),
            ComponentState::Running(_) => None,
            _ => self.announcement.as_ref().map(|announcement| announcement.pid),
        }
    }

    /// Processor time and memory of its process, if it runs and is visible from here.
    pub fn process_figures(&self) -> Option<ProcessFigures> {
        self.process_id().filter(|_| self.is_running()).and_then(ProcessFigures::read)
    }

    /// The other host on which the component runs, if it does. Its process here is then the gateway that stands in for
    /// it.
    pub fn host(&self) -> Option<&str> {
        self.announcement.as_ref()?.host.as_deref()
    }

    /// The latest figures of the gate with this number, if they belong to its plan and to this run.
    pub fn figures(&self, gate: usize) -> Option<&GateFigures> {
        let (stats, announcement) = (self.stats.as_ref()?, self.announcement.as_ref()?);
        let belongs = stats.pid == announcement.pid && stats.gates.len() == self.gates().len();
        stats.gates.get(gate).filter(|_| belongs)
    }

    /// Returns the component as JSON, without its gates.
    pub fn to_json(&self, now: SystemTime) -> Value {
        let announcement = self.announcement.as_ref();
        json!({
            "name": self.name,
            "state": self.state_word(),
            "pid": self.process_id(),
            "host": self.host(),
            "program": announcement.map(|it| it.program.to_string_lossy()),
            "started": announcement.map(|it| timestamp(it.started)),
            "declared_at": self.plan().map(|plan| &plan.declared_at),
            "ready": self.stats.as_ref().filter(|_| self.is_running()).map(|stats| stats.ready),
            "silent_for_s": self.silent_for(now).map(|silence| silence.as_secs_f64()),
            "stats_period_s": self.stats.as_ref().map(|stats| stats.period.as_secs_f64()),
        })
    }

    /// Returns one of its gates as JSON, with its figures and its rate if they are known.
    pub fn gate_to_json(&self, gate: usize, rate: Option<GateRate>) -> Value {
        let Some(plan) = self.gates().get(gate) else { return Value::Null };
        let figures = self.figures(gate);
        let peers = peers(plan, figures);
        let transports = self.transports(&plan.name).into_iter();
        json!({
            "name": format!("{}.{}", self.name, plan.name),
            "kind": plan.kind.word(),
            "type": payload_to_json(&plan.payload),
            "codec": plan.codec,
            "contract": plan.contract,
            "declared_at": plan.declared_at,
            "tap": plan.tap,
            "transports": transports.map(|(name, peers)| json!({"name": name, "peers": peers})).collect::<Vec<_>>(),
            "options": options_to_json(plan),
            "peers": peers.iter().map(peer_to_json).collect::<Vec<_>>(),
            "figures": figures.map(|figures| figures_to_json(plan, figures)),
            "rate": rate.map(|rate| json!({"messages_per_s": rate.messages, "bytes_per_s": rate.bytes})),
        })
    }
}

fn payload_to_json(payload: &Payload) -> Value {
    match payload {
        Payload::Bytes => Value::Null,
        Payload::Message(name) => json!({"message": name}),
        Payload::Exchange { request, reply } => json!({"request": request, "reply": reply}),
    }
}

fn options_to_json(plan: &GatePlan) -> Value {
    let options = &plan.options;
    json!({
        "max_size": options.max_size,
        "queue": options.queue,
        "when_full": options.when_full.word(),
        "backpressure": options.backpressure,
        "timeout_s": options.timeout.as_secs_f64(),
        "period_s": options.period.map(|period| period.as_secs_f64()),
        "deadline_s": options.deadline.map(|deadline| deadline.as_secs_f64()),
        "max_age_s": options.max_age.map(|max_age| max_age.as_secs_f64()),
    })
}

fn peer_to_json(peer: &Peer<'_>) -> Value {
    json!({
        "name": peer.name(),
        "connected": peer.connected,
        "required": peer.plan.required,
        "queue": peer.plan.queue,
        "when_full": peer.plan.when_full.word(),
        "figures": peer.figures.map(connection_to_json),
    })
}

fn connection_to_json(figures: &ConnectionFigures) -> Value {
    json!({
        "waiting": figures.waiting,
        "in_flight": figures.in_flight,
        "taken": figures.taken,
        "latched": figures.latched,
        "missed": figures.missed,
        "expired": figures.expired,
        "replaced": figures.replaced,
        "dropped": figures.dropped,
        "lost": figures.lost,
    })
}

fn figures_to_json(plan: &GatePlan, figures: &GateFigures) -> Value {
    json!({
        "messages": message_count(plan.kind, figures),
        "sent": figures.sent,
        "received": figures.received,
        "bytes": figures.bytes,
        "waiting": figures.waiting,
        "peers": figures.peers,
        "replaced": figures.replaced,
        "dropped_oldest": figures.dropped_oldest,
        "dropped_newest": figures.dropped_newest,
        "dropped_for_observers": figures.dropped_for_observers,
        "tap_dropped": figures.tap_dropped,
        "lost": figures.lost,
        "rejected": figures.rejected,
        "undecodable": figures.undecodable,
        "missed": figures.missed,
        "expired": figures.expired,
        "last_activity": figures.last_activity.map(timestamp),
    })
}
