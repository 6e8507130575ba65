//! A gate or a component as text.

use super::Reading;
use crate::list::state_text;
use scl::runtime_dir::{ConnectionFigures, GateFigures};
use scl_observe::{Component, Peer, connected_peers, message_count, peers};
use scl_plan::{GateKind, GateOptions, GatePlan};
use scl_terminal::{Table, age_text, bytes_text, three_digits};
use scl_text::duration;
use std::time::SystemTime;

impl Reading {
    /// Describes the gate with this index, or the whole component.
    pub(super) fn text(&self, gate: Option<usize>) -> String {
        match gate.and_then(|gate| Some((gate, self.component.gates().get(gate)?))) {
            Some((gate, plan)) => self.gate_text(gate, plan),
            None => self.component_text(),
        }
    }

    fn component_text(&self) -> String {
        let component = &self.component;
        let mut facts = Table::plain(2).indented(2);
        facts.row(["state", &state_text(component, self.now)]);
        if let Some(announcement) = &component.announcement {
            let label = if component.is_running() { "process" } else { "last process" };
            let id = component.process_id().map_or_else(|| "in another container".to_owned(), |id| id.to_string());
            facts.row([label, &id]);
            facts.row(["program", &announcement.program.to_string_lossy()]);
            if let Some(host) = component.host() {
                facts.row([
                    "runs on",
                    &format!("host {}, for which this gateway stands in", scl_terminal::escape(host)),
                ]);
            }
            facts.row(["started", &format!("{} ago", ago(self.now, announcement.started))]);
        }
        if let Some(plan) = component.plan() {
            facts.row(["declared", &plan.declared_at]);
        }
        facts.row(["figures", &self.figures_text()]);
        for (index, (plan, value)) in component.parameters().enumerate() {
            let unit = plan.unit.as_ref().map_or(String::new(), |unit| format!(" {unit}"));
            let live = if plan.live { ", live" } else { "" };
            let value = scl_terminal::escape(value.unwrap_or("?"));
            let label = if index == 0 { "parameters" } else { "" };
            facts.row([label, &format!("{} = {value}{unit}{live}", plan.name)]);
        }
        let mut gates = Table::with_headings(&["GATE", "KIND", "TYPE", "CODEC"], &["MSG/S", "DROPS", "PEERS"]);
        for (index, gate) in component.gates().iter().enumerate() {
            let figures = component.figures(index);
            let connected = connected_peers(gate, figures).map_or_else(|| "?".to_owned(), |count| count.to_string());
            gates.row([
                gate.name.clone(),
                gate.kind.word().to_owned(),
                gate.payload.to_string(),
                gate.codec.clone(),
                self.rate(index).map_or_else(|| "?".to_owned(), |rate| three_digits(rate.messages)),
                figures.map_or_else(|| "?".to_owned(), |figures| drops(figures).to_string()),
                format!("{connected}/{}", gate.connections.len()),
            ]);
        }
        let gates = if gates.is_empty() { String::new() } else { format!("\n{}", gates.text()) };
        format!("{}\n{}{gates}", component.name, facts.text())
    }

    fn gate_text(&self, index: usize, plan: &GatePlan) -> String {
        let component = &self.component;
        let mut facts = Table::plain(2).indented(2);
        facts.row(["component", &format!("{}, {}", component.name, state_text(component, self.now))]);
        facts.row(["kind", plan.kind.word()]);
        facts.row(["type", &plan.payload.to_string()]);
        facts.row(["codec", &plan.codec]);
        for (label, value) in options(plan) {
            facts.row([label, &value]);
        }
        facts.row(["contract", &plan.contract]);
        facts.row(["declared", &plan.declared_at]);
        if let Some(tap) = &plan.tap {
            facts.row(["tap", tap]);
        }
        if let Some(transports) = transports(component, &plan.name) {
            facts.row(["transport", &transports]);
        }
        let figures = component.figures(index);
        match figures {
            Some(figures) => self.add_figures(&mut facts, index, plan.kind, figures),
            None => facts.row(["figures", &self.figures_text()]),
        }
        let peers = peers(plan, figures);
        let peers = if peers.is_empty() { "  peers    none\n".to_owned() } else { peer_table(&peers, &plan.options) };
        format!("{}.{}\n{}\n{peers}", component.name, plan.name, facts.text())
    }

    fn add_figures(&self, facts: &mut Table, index: usize, kind: GateKind, figures: &GateFigures) {
        let rate = self.rate(index).map_or_else(
            || "unknown: no second reading of the figures".to_owned(),
            |rate| format!("{}/s, {}/s", three_digits(rate.messages), bytes_text(rate.bytes)),
        );
        facts.row(["rate", &rate]);
        let verb = if kind.is_source() { "sent" } else { "received" };
        let last = figures.last_activity.map(|last| format!(", last {} ago", ago(self.now, last))).unwrap_or_default();
        facts.row([verb, &format!("{}{last}", message_count(kind, figures))]);
        facts.row(["waiting", &figures.waiting.to_string()]);
        facts.row(["dropped", &drops(figures).to_string()]);
        for (label, count) in [
            ("replaced", figures.replaced),
            ("lost", figures.lost),
            ("rejected", figures.rejected),
            ("undecodable", figures.undecodable),
            ("missed", figures.missed),
            ("expired", figures.expired),
            ("tap drops", figures.tap_dropped),
        ] {
            if count > 0 {
                facts.row([label, &count.to_string()]);
            }
        }
    }

    /// How old the figures are, or why there are none.
    fn figures_text(&self) -> String {
        let component = &self.component;
        match &component.stats {
            Some(stats) => {
                format!("written {} ago, every {}", ago(self.now, stats.written), age_text(stats.period))
            }
            None if component.host().is_some() => "none here: they are on its own host".to_owned(),
            None if component.is_running() => "none: the program runs with `SCL_STATS=off`".to_owned(),
            None => "none".to_owned(),
        }
    }
}

/// Returns the transports on which a gate listens, for example `shm`, or `ipc to logger.frames; shm to viewer.frames`;
/// `None` if it does not listen, or only on the default, `ipc`.
fn transports(component: &Component, gate: &str) -> Option<String> {
    match &component.transports(gate)[..] {
        [] | [("ipc", _)] => None,
        [(transport, _)] => Some((*transport).to_owned()),
        several => {
            let texts = several.iter().map(|(transport, peers)| format!("{transport} to {}", peers.join(", ")));
            Some(texts.collect::<Vec<_>>().join("; "))
        }
    }
}

fn options(plan: &GatePlan) -> Vec<(&'static str, String)> {
    let (options, kind) = (&plan.options, plan.kind);
    let mut rows = Vec::new();
    if matches!(kind, GateKind::Sub | GateKind::Pull) {
        rows.push(("queue", format!("{}, {}", options.queue, options.when_full.word())));
    }
    if options.backpressure {
        rows.push(("backpressure", "true".to_owned()));
    }
    if kind == GateKind::Req {
        rows.push(("timeout", duration::text(options.timeout)));
    }
    for (label, interval) in [("period", options.period), ("deadline", options.deadline), ("max_age", options.max_age)]
    {
        rows.extend(interval.map(|interval| (label, duration::text(interval))));
    }
    rows.push(("max_size", bytes_text(options.max_size as f64)));
    rows
}

/// A column of figures of a connection.
type Column = (&'static str, fn(&ConnectionFigures) -> u64);

fn peer_table(peers: &[Peer<'_>], options: &GateOptions) -> String {
    let mut columns: Vec<Column> = vec![
        ("WAITING", |it| it.waiting),
        ("TAKEN", |it| it.taken),
        ("REPLACED", |it| it.replaced),
        ("DROPPED", |it| it.dropped),
        ("LOST", |it| it.lost),
    ];
    columns.extend(options.deadline.map(|_| -> Column { ("MISSED", |it| it.missed) }));
    columns.extend(options.max_age.map(|_| -> Column { ("EXPIRED", |it| it.expired) }));
    let headings: Vec<_> = ["QUEUE"].into_iter().chain(columns.iter().map(|(heading, _)| *heading)).collect();
    let mut table = Table::with_headings(&["PEER", "CONNECTED"], &headings).indented(2);
    for peer in peers {
        let connected = match peer.connected {
            Some(true) => "yes",
            Some(false) if peer.plan.required => "no",
            Some(false) => "no (optional)",
            None => "?",
        };
        let count = |of: &fn(&ConnectionFigures) -> u64| peer.figures.map_or("?".to_owned(), |it| of(it).to_string());
        let start = [peer.name(), connected.to_owned(), peer.plan.queue.to_string()];
        table.row(start.into_iter().chain(columns.iter().map(|(_, of)| count(of))));
    }
    table.text()
}

fn drops(figures: &GateFigures) -> u64 {
    figures.dropped_oldest + figures.dropped_newest
}

fn ago(now: SystemTime, then: SystemTime) -> String {
    age_text(now.duration_since(then).unwrap_or_default())
}
