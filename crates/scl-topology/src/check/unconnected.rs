//! Gates without a peer. SCL0701: a sender without receivers. SCL0702: a receiver without senders. SCL0703: a requester
//! without a replier. SCL0704: a replier without requesters. SCL0705: a component without any connection, which says
//! more than a warning for each of its gates.

use super::draft::{Draft, DraftComponent};
use super::fitting_sender::FittingSenders;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::topology::GateKind;
use scl_text::list::listed;

/// SCL0701.
pub(crate) const NO_RECEIVER: Rule = Rule {
    code: "SCL0701",
    severity: Severity::Warning,
    title: "publisher without subscribers",
    explanation: "A sending gate has no receiver, so its messages are dropped. Connect it, or remove it. If that is \
                  intended, write `unconnected: ok`, which works for a gate without a type too: `events: {pub: , \
                  unconnected: ok}`.",
    example: " components:
   - name: controller
     gates:
-      - events: pub
+      - events: {pub: , unconnected: ok}
",
};

/// SCL0702.
pub(crate) const NO_SENDER: Rule = Rule {
    code: "SCL0702",
    severity: Severity::Warning,
    title: "subscriber without a publisher",
    explanation: "A receiving gate is not connected, so a program that waits for its messages never gets one. Connect \
                  it; the message suggests senders that fit. If that is intended, write `unconnected: ok`.",
    example: " components:
   - name: controller
     gates:
-      - sensor: sub
+      - sensor: {sub: , unconnected: ok}
",
};

/// SCL0703.
pub(crate) const NO_REPLIER: Rule = Rule {
    code: "SCL0703",
    severity: Severity::Error,
    title: "requester without a replier",
    explanation: "A requester has no replier, so every call would time out. Connect it, or write `unconnected: ok`. If \
                  the replier is a program outside of SCL, allow the error with a reason.",
    example: " components:
   - name: ui
     gates:
-      - commands: req
+      - commands: {req: , unconnected: ok}
",
};

/// SCL0704.
pub(crate) const NO_REQUESTER: Rule = Rule {
    code: "SCL0704",
    severity: Severity::Warning,
    title: "replier without requesters",
    explanation: "A replier has no requester, so it never gets a request. Connect it, or write `unconnected: ok` if \
                  requesters connect from outside the system.",
    example: " components:
   - name: controller
     gates:
-      - commands: rep
+      - commands: {rep: , unconnected: ok}
",
};

/// SCL0705.
pub(crate) const LONELY_COMPONENT: Rule = Rule {
    code: "SCL0705",
    severity: Severity::Warning,
    title: "component without any connection",
    explanation: "None of the component's gates is connected. This is one warning for all of them. Connect the \
                  component, or remove it.",
    example: " components:
   - name: logger
     gates:
       - a: sub
-      - b: sub
+  - name: sensor
+    gates:
+      - a: pub
+connections:
+  - [sensor.a, logger.a]
",
};

/// In a file without the section `connections`, more problems than this add nothing to the report that the section is
/// missing.
const MOST_WITHOUT_SECTION: usize = 2;

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let found = each_gate(draft);
    let is_section_missing = draft.model.connections_key.is_none() && draft.links.is_empty();
    match is_section_missing && found.len() > MOST_WITHOUT_SECTION {
        true => problems.extend(without_section(found)),
        false => problems.extend(found),
    }
}

/// Returns what remains to be reported if the section is reported as missing: all requesters without a replier, as one
/// error.
fn without_section(found: Vec<Diagnostic>) -> Option<Diagnostic> {
    let mut requesters = found.into_iter().filter(|problem| *problem.rule == NO_REPLIER);
    let mut first = requesters.next()?;
    for other in requesters {
        other.primary.iter().for_each(|gate| first.add_label(gate.span, "nobody answers this one either"));
    }
    Some(first)
}

fn each_gate(draft: &Draft<'_>) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    let senders = FittingSenders::of(draft);
    for component in &draft.components {
        let open: Vec<usize> = component.gates.iter().copied().filter(|&gate| is_open(draft, gate)).collect();
        let warned = open.iter().filter(|&&gate| draft.gates[gate].kind != Some(GateKind::Req)).count();
        let alone = component.gates.iter().all(|&gate| !draft.gates[gate].named);
        // A single gate is better explained by its own warning.
        let lonely = alone && warned > 1 && !component.model.gates_unread;
        if lonely {
            problems.push(lonely_component(draft, component, &open));
        }
        for gate in open {
            match draft.gates[gate].kind {
                Some(GateKind::Req) => problems.push(no_replier(draft, gate)),
                Some(kind) if !lonely => problems.push(no_peer(draft, gate, kind, &senders)),
                _ => {}
            }
        }
    }
    problems
}

fn is_open(draft: &Draft<'_>, gate: usize) -> bool {
    let gate = &draft.gates[gate];
    !gate.named && !gate.duplicate && !gate.options.unconnected_ok && gate.kind.is_some()
}

fn lonely_component(draft: &Draft<'_>, component: &DraftComponent<'_>, open: &[usize]) -> Diagnostic {
    let name = &component.model.name;
    let headline = format!("component `{}` is not connected to anything", name.value);
    let gates: Vec<String> = open.iter().map(|&gate| draft.name_and_kind(gate)).collect();
    LONELY_COMPONENT
        .at(headline, name.span, format!("{} gates, 0 connections", component.gates.len()))
        .help("connect it or remove it")
        .note(format!("gates without a peer: {}", gates.join(", ")))
}

fn no_peer(draft: &Draft<'_>, gate: usize, kind: GateKind, senders: &FittingSenders<'_>) -> Diagnostic {
    let place = draft.gates[gate].model.name.span;
    let path = draft.path(gate);
    let no_receiver =
        |does, label| NO_RECEIVER.at(format!("nobody {does} `{path}`"), place, label).help(ways_out(draft, gate));
    match kind {
        GateKind::Pub => no_receiver("subscribes to", "its messages are dropped"),
        GateKind::Push => no_receiver("pulls from", "its messages go nowhere"),
        GateKind::Rep => NO_REQUESTER
            .at(format!("nobody sends requests to `{path}`"), place, "")
            .help("connect it, or write `unconnected: ok`"),
        _ => never_receives(draft, gate, kind, senders),
    }
}

fn never_receives(draft: &Draft<'_>, gate: usize, kind: GateKind, senders: &FittingSenders<'_>) -> Diagnostic {
    let headline = format!("gate `{}` is not connected; it will never receive a message", draft.path(gate));
    let found = NO_SENDER.at(headline, draft.gates[gate].model.name.span, "");
    let fitting = senders.for_gate(draft, gate);
    if fitting.is_empty() {
        return found.help(ways_out(draft, gate));
    }
    let who = if kind == GateKind::Pull { "pushers" } else { "publishers" };
    found.help(format!("{who} of a fitting type: {}", listed(fitting.into_iter().map(|sender| draft.path(sender)))))
}

fn no_replier(draft: &Draft<'_>, gate: usize) -> Diagnostic {
    let headline = format!("gate `{}` is not connected; every request would wait until its timeout", draft.path(gate));
    NO_REPLIER
        .at(headline, draft.gates[gate].model.name.span, "nobody answers")
        .help("connect it to a `rep` gate")
        .help("or write `unconnected: ok`")
}

fn ways_out(draft: &Draft<'_>, gate: usize) -> String {
    let model = draft.gates[gate].model;
    let (name, kind, types) = (&model.name.value, &model.kind.value, type_text(draft, gate));
    format!("connect it, remove it, or write `{name}: {{{kind}: {types}, unconnected: ok}}`")
}

/// The type of a gate as written in the file; empty for a gate without one.
pub(super) fn type_text(draft: &Draft<'_>, gate: usize) -> String {
    let from = draft.gates[gate].payload_from.unwrap_or(gate);
    draft.gates[from].model.payload.as_ref().map_or_else(String::new, |payload| payload.value.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::{LONELY_COMPONENT, NO_RECEIVER, NO_REPLIER, NO_REQUESTER, NO_SENDER};
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn publisher_without_subscribers() {
        rule_example(
            &NO_RECEIVER,
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
        rule_example(
            &NO_SENDER,
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
        rule_example(
            &NO_REPLIER,
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
        rule_example(
            &NO_REQUESTER,
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
        rule_example(
            &LONELY_COMPONENT,
            expect![[r#"
                warning: [SCL0705] component `logger` is not connected to anything
                 --> topology.yaml:2:11
                  |
                2 |   - name: logger
                  |           ^^^^^^ 2 gates, 0 connections
                  |
                  = help: connect it or remove it
                  = note: gates without a peer: `a` (sub), `b` (sub)
            "#]],
        );
    }
}
