//! Gates without a peer. SCL0701: a sender without receivers. SCL0702: a receiver without senders. SCL0703: a requester
//! without a replier. SCL0704: a replier without requesters. SCL0705: a component without any connection, which says
//! more than a warning for each of its gates.

use super::commented_out::as_comment;
use super::draft::{Draft, DraftComponent};
use super::fitting_gate::FittingGates;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::source::Span;
use crate::topology::GateKind;

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
    let ways = Ways::of(draft);
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
                Some(kind @ GateKind::Req) => problems.push(no_peer(draft, gate, kind, &ways)),
                Some(kind) if !lonely => problems.push(no_peer(draft, gate, kind, &ways)),
                _ => {}
            }
        }
    }
    problems
}

/// What a gate without a peer may be connected to.
struct Ways<'m> {
    fitting: FittingGates<'m>,
    /// By gate: a component of its kind has a connection to it. Known of the first component.
    is_named: Vec<bool>,
}

impl<'m> Ways<'m> {
    fn of(draft: &Draft<'m>) -> Self {
        let mut is_named = vec![false; draft.gates.len()];
        for (at, gate) in draft.gates.iter().enumerate() {
            is_named[draft.shared(at)] |= gate.named;
        }
        Self { fitting: FittingGates::of(draft), is_named }
    }

    /// A gate as an end of a new connection: `each motor.state` if none of the motors has one.
    fn end(&self, draft: &Draft<'_>, gate: usize) -> String {
        if self.is_named[draft.shared(gate)] { draft.path(gate) } else { draft.shared_path(gate) }
    }
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
        .help("each gate has a connection or the option `unconnected: ok`")
        .note(format!("gates without a peer: {}", gates.join(", ")))
}

fn no_peer(draft: &Draft<'_>, gate: usize, kind: GateKind, ways: &Ways<'_>) -> Diagnostic {
    let place = draft.gates[gate].model.name.span;
    let path = draft.path(gate);
    let found = match kind {
        GateKind::Pub => NO_RECEIVER.at(format!("nobody subscribes to `{path}`"), place, "its messages are dropped"),
        GateKind::Push => NO_RECEIVER.at(format!("nobody pulls from `{path}`"), place, "its messages go nowhere"),
        GateKind::Rep => NO_REQUESTER.at(format!("nobody sends requests to `{path}`"), place, ""),
        GateKind::Req => {
            let headline = format!("gate `{path}` is not connected; every request would wait until its timeout");
            NO_REPLIER.at(headline, place, "nobody answers")
        }
        GateKind::Sub | GateKind::Pull => {
            let headline = format!("gate `{path}` is not connected; it will never receive a message");
            NO_SENDER.at(headline, place, "")
        }
    };
    with_ways(draft, found, gate, kind, ways)
}

/// Suggests the connections to gates that fit, and the mark of a gate that is meant to be unconnected.
fn with_ways(draft: &Draft<'_>, found: Diagnostic, gate: usize, kind: GateKind, ways: &Ways<'_>) -> Diagnostic {
    // A receiver or requester that has a peer already expects no other.
    let is_free = |at: &usize| kind == GateKind::Sub || kind == GateKind::Req || !draft.gates[*at].named;
    let fitting: Vec<usize> = ways.fitting.for_gate(draft, gate).into_iter().filter(is_free).collect();
    let found = match in_comment(draft, gate) {
        Some(edit) => found.suggest("if it belongs to the comment above it, make it a comment, too", [edit]),
        None => found,
    };
    let misled = fitting.iter().filter(|_| kind == GateKind::Sub);
    let misled = misled.filter_map(|&other| Some((other, ways.fitting.misled(draft, other, gate)?)));
    let found = misled.fold(found, |found, (other, (link, twin))| {
        let place = draft.end_span(link, twin);
        let (own, twin) = (draft.path(gate), draft.path(twin));
        let help = format!("write `{own}` in place of `{twin}` in the connection with `{}`", draft.path(other));
        found.suggest(help, [Edit::new(place, draft.sources.quoted_as(place, &own))]).label(place, "this may be meant")
    });
    let own = ways.end(draft, gate);
    let mut others: Vec<String> = fitting.iter().map(|other| ways.end(draft, *other)).collect();
    others.dedup();
    let found = others.iter().fold(found, |found, other| {
        let pair = match kind.is_source() {
            true => format!("[{own}, {other}]"),
            false => format!("[{other}, {own}]"),
        };
        match new_connection(draft, &pair) {
            Some(edit) => found.suggest(format!("add the connection `{pair}`"), [edit]),
            None => found.help(format!("a connection of gates that fit: `{pair}`")),
        }
    });
    let found = match fitting.is_empty() {
        true => found.help(format!("a `{}` gate connects to a `{}` gate", kind.word(), kind.opposite().word())),
        false => found,
    };
    let mark = draft.with_option(gate, "unconnected", "ok");
    found.suggest("or write `unconnected: ok`, if that is intended", [mark])
}

/// The change that makes a comment of a gate right below `# gates:`, which belongs to a component in the comment.
fn in_comment(draft: &Draft<'_>, gate: usize) -> Option<Edit> {
    let place = draft.gates[gate].model.span;
    let file = draft.sources.file(place.file);
    let line = file.line_range(place.start as usize);
    let above = file.text().get(..line.start)?.lines().next_back()?.trim();
    let is_gates = above.starts_with('#') && above.trim_start_matches(['#', ' ']) == "gates:";
    if is_gates { as_comment(draft, place) } else { None }
}

/// The change that adds a line below the last connection, if each has a line of its own.
pub(super) fn new_connection(draft: &Draft<'_>, pair: &str) -> Option<Edit> {
    let last = draft.model.connections.last()?.span;
    let file = draft.sources.file(last.file);
    let line = file.line_range(last.start as usize);
    let (head, tail) = (&file.text()[line.start..last.start as usize], file.text().get(last.end as usize..line.end)?);
    let rest = tail.trim_start();
    let indent = head.strip_suffix("- ").filter(|indent| indent.trim().is_empty())?;
    let end = Span { start: line.end as u32, end: line.end as u32, ..last };
    (rest.is_empty() || rest.starts_with('#')).then(|| Edit::new(end, format!("\n{indent}- {pair}")))
}

/// The type of a gate as written in the file; empty for a gate without one.
pub(super) fn type_text(draft: &Draft<'_>, gate: usize) -> String {
    let from = draft.gates[gate].payload_from.unwrap_or(gate);
    draft.gates[from].model.payload.as_ref().map_or_else(String::new, |payload| payload.value.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::{LONELY_COMPONENT, NO_RECEIVER, NO_REPLIER, NO_REQUESTER, NO_SENDER};
    use crate::check::testing::{example, rule_example};
    use expect_test::expect;

    #[test]
    fn the_gate_that_may_be_meant() {
        let gates = "components:\n  - name: a\n    gates:\n      - x_1: {pub: T}\n      - x_2: {pub: T}\n  \
                     - name: b\n    gates:\n      - x: {sub: T}\n";
        let connections = "connections:\n  - [a.x_1, b.x]\n  - [a.x_2, b.x]\n";
        let twin = "  - name: c\n    gates:\n      - x: {sub: T}\n";
        example(
            "SCL0702",
            &format!("{gates}{twin}{connections}"),
            expect![[r#"
            warning: [SCL0702] gate `c.x` is not connected; it will never receive a message
              --> topology.yaml:11:9
               |
            11 |       - x: {sub: T}
               |         ^
            ...
            14 |   - [a.x_2, b.x]
               |             --- this may be meant
               |
               = help: write `c.x` in place of `b.x` in the connection with `a.x_2`
               = help: add the connection `[a.x_1, c.x]`
               = help: add the connection `[a.x_2, c.x]`
               = help: or write `unconnected: ok`, if that is intended
        "#]],
        );
        let in_comment = "  # - name: c\n  #   gates:\n      - y: {sub: T}\n";
        example(
            "SCL0702",
            &format!("{gates}{in_comment}{connections}"),
            expect![[r#"
            warning: [SCL0702] gate `b.y` is not connected; it will never receive a message
              --> topology.yaml:11:9
               |
            11 |       - y: {sub: T}
               |         ^
               |
               = help: if it belongs to the comment above it, make it a comment, too
               = help: add the connection `[a.x_1, b.y]`
               = help: add the connection `[a.x_2, b.y]`
               = help: or write `unconnected: ok`, if that is intended
        "#]],
        );
    }

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
                  = help: a `pub` gate connects to a `sub` gate
                  = help: or write `unconnected: ok`, if that is intended
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
                  = help: a `sub` gate connects to a `pub` gate
                  = help: or write `unconnected: ok`, if that is intended
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
                  = help: a `req` gate connects to a `rep` gate
                  = help: or write `unconnected: ok`, if that is intended
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
                  = help: a `rep` gate connects to a `req` gate
                  = help: or write `unconnected: ok`, if that is intended
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
                  = help: each gate has a connection or the option `unconnected: ok`
                  = note: gates without a peer: `a` (sub), `b` (sub)
            "#]],
        );
    }
}
