//! Gates without a peer. SCL0701: nobody receives what a gate sends. SCL0702: a gate never receives anything. SCL0703:
//! nobody answers. SCL0704: nobody asks. SCL0705: a whole component hangs in the air, which says more than a warning for
//! each of its gates.

use super::draft::Draft;
use super::fitting_sender::FittingSenders;
use super::wording::listed;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::topology::GateKind;

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let senders = FittingSenders::of(draft);
    for component in &draft.components {
        let open: Vec<usize> = component.gates.iter().copied().filter(|&gate| is_open(draft, gate)).collect();
        let warned = open.iter().filter(|&&gate| draft.gates[gate].kind != Some(GateKind::Req)).count();
        let alone = component.gates.iter().all(|&gate| !draft.gates[gate].named);
        // One gate alone is explained better by its own warning.
        let lonely = alone && warned > 1 && !component.model.gates_unread;
        if lonely {
            problems.push(lonely_component(component.model, warned));
        }
        for gate in open {
            match draft.gates[gate].kind {
                Some(GateKind::Req) => problems.push(no_replier(draft, gate)),
                Some(kind) if !lonely => problems.push(no_peer(draft, gate, kind, &senders)),
                _ => {}
            }
        }
    }
}

fn is_open(draft: &Draft<'_>, gate: usize) -> bool {
    let gate = &draft.gates[gate];
    !gate.named && !gate.duplicate && !gate.options.unconnected_ok && gate.kind.is_some()
}

fn lonely_component(component: &crate::model::ComponentModel, warned: usize) -> Diagnostic {
    let name = &component.name;
    let headline = format!("component `{}` is not connected to anything", name.value);
    Diagnostic::warning("SCL0705", headline, name.span, format!("{} gates, 0 connections", component.gates.len()))
        .help("connect it or remove it")
        .note(format!("the {warned} warnings for its gates are not shown"))
}

fn no_peer(draft: &Draft<'_>, gate: usize, kind: GateKind, senders: &FittingSenders<'_>) -> Diagnostic {
    let place = draft.gates[gate].model.name.span;
    let path = draft.path(gate);
    match kind {
        GateKind::Pub => {
            Diagnostic::warning("SCL0701", format!("nobody subscribes to `{path}`"), place, "its messages are dropped")
                .help(ways_out(draft, gate))
        }
        GateKind::Push => {
            Diagnostic::warning("SCL0701", format!("nobody pulls from `{path}`"), place, "its messages go nowhere")
                .help(ways_out(draft, gate))
        }
        GateKind::Rep => Diagnostic::warning("SCL0704", format!("nobody sends requests to `{path}`"), place, "")
            .help("connect it, or write `unconnected: ok`"),
        _ => never_receives(draft, gate, kind, senders),
    }
}

fn never_receives(draft: &Draft<'_>, gate: usize, kind: GateKind, senders: &FittingSenders<'_>) -> Diagnostic {
    let headline = format!("gate `{}` is not connected; it will never receive a message", draft.path(gate));
    let found = Diagnostic::warning("SCL0702", headline, draft.gates[gate].model.name.span, "");
    let fitting = senders.for_gate(draft, gate);
    if fitting.is_empty() {
        return found.help(ways_out(draft, gate));
    }
    let who = if kind == GateKind::Pull { "pushers" } else { "publishers" };
    found.help(format!("{who} of a fitting type: {}", listed(fitting.into_iter().map(|sender| draft.path(sender)))))
}

fn no_replier(draft: &Draft<'_>, gate: usize) -> Diagnostic {
    let headline = format!("gate `{}` is not connected; every request would wait until its timeout", draft.path(gate));
    Diagnostic::error("SCL0703", headline, draft.gates[gate].model.name.span, "nobody answers")
        .help("connect it to a `rep` gate")
        .help("or write `unconnected: ok`")
}

fn ways_out(draft: &Draft<'_>, gate: usize) -> String {
    let model = draft.gates[gate].model;
    let (name, kind, types) = (&model.name.value, &model.kind.value, type_text(draft, gate));
    format!("connect it, remove it, or write `{name}: {{{kind}: {types}, unconnected: ok}}`")
}

/// The type of a gate as one would write it; nothing for a gate without one.
pub(super) fn type_text(draft: &Draft<'_>, gate: usize) -> String {
    let from = draft.gates[gate].payload_from.unwrap_or(gate);
    match &draft.gates[from].model.payload {
        Some(payload) => payload.value.trim().to_owned(),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::example;
    use expect_test::expect;

    #[test]
    fn publisher_without_subscribers() {
        let yaml = r#"
components:
  - name: controller
    gates:
      - events: pub
"#;
        example(
            "SCL0701",
            yaml.trim_start(),
            expect![[r#"
                warning: [SCL0701] nobody subscribes to `controller.events`
                 --> topology.yaml:4:9
                  |
                4 |       - events: pub
                  |         ^^^^^^ its messages are dropped
                  |
                  = help: connect it, remove it, or write `events: {pub: , unconnected: ok}`
            "#]],
        );
    }

    #[test]
    fn subscriber_without_a_publisher() {
        let yaml = r#"
components:
  - name: controller
    gates:
      - sensor: sub
"#;
        example(
            "SCL0702",
            yaml.trim_start(),
            expect![[r#"
                warning: [SCL0702] gate `controller.sensor` is not connected; it will never receive a message
                 --> topology.yaml:4:9
                  |
                4 |       - sensor: sub
                  |         ^^^^^^
                  |
                  = help: connect it, remove it, or write `sensor: {sub: , unconnected: ok}`
            "#]],
        );
    }

    #[test]
    fn requester_without_a_replier() {
        let yaml = r#"
components:
  - name: ui
    gates:
      - commands: req
"#;
        example(
            "SCL0703",
            yaml.trim_start(),
            expect![[r#"
            error: [SCL0703] gate `ui.commands` is not connected; every request would wait until its timeout
             --> topology.yaml:4:9
              |
            4 |       - commands: req
              |         ^^^^^^^^ nobody answers
              |
              = help: connect it to a `rep` gate
              = help: or write `unconnected: ok`
        "#]],
        );
    }

    #[test]
    fn replier_without_requesters() {
        let yaml = r#"
components:
  - name: controller
    gates:
      - commands: rep
"#;
        example(
            "SCL0704",
            yaml.trim_start(),
            expect![[r#"
            warning: [SCL0704] nobody sends requests to `controller.commands`
             --> topology.yaml:4:9
              |
            4 |       - commands: rep
              |         ^^^^^^^^
              |
              = help: connect it, or write `unconnected: ok`
        "#]],
        );
    }

    #[test]
    fn component_without_any_connection() {
        let yaml = r#"
components:
  - name: logger
    gates:
      - a: sub
      - b: sub
"#;
        example(
            "SCL0705",
            yaml.trim_start(),
            expect![[r#"
            warning: [SCL0705] component `logger` is not connected to anything
             --> topology.yaml:2:11
              |
            2 |   - name: logger
              |           ^^^^^^ 2 gates, 0 connections
              |
              = help: connect it or remove it
              = note: the 2 warnings for its gates are not shown
        "#]],
        );
    }
}
