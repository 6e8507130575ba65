//! Connections that go round in a circle. SCL0707: requests, so that everybody may wait for everybody. SCL0708: work that
//! is pushed on. SCL0709, a lint: messages that come back to their publisher.

use super::component_graph::{ComponentGraph, Step};
use super::draft::Draft;
use crate::diagnostic::Severity;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::rule::{Examples, Rule};
use crate::source::Span;
use crate::topology::{GateKind, WhenFull};

/// SCL0707.
pub(crate) const REQUESTS: Rule = Rule {
    code: "SCL0707",
    severity: Severity::Error,
    title: "cycle of requests",
    explanation: "Each component of a circle asks the next one. If each does so while it answers, all of them wait for \
                  ever. Let one side publish what the other asks for, or, if no component asks while it answers, allow \
                  it: `# scl: allow(SCL0707) reason` above one of the connections.",
    examples: Examples::Topology {
        bad: "components:
  - name: arbiter
    gates:
      - power: req
      - mission: rep
  - name: power
    gates:
      - status: rep
      - mission: req
connections:
  - [arbiter.power, power.status]
  - [power.mission, arbiter.mission]
",
        good: "components:
  - name: arbiter
    gates:
      - power: req
      - mission: pub
  - name: power
    gates:
      - status: rep
      - mission: sub
connections:
  - [arbiter.power, power.status]
  - [power.mission, arbiter.mission]
",
    },
};

/// SCL0708.
pub(crate) const PUSHES: Rule = Rule {
    code: "SCL0708",
    severity: Severity::Warning,
    title: "cycle of push gates",
    explanation: "Work is pushed round in a circle. With `when_full: wait` all of them can stop, each waiting for room \
                  in the queue of the next; without it work is lost when the queues are full. Make one of the links \
                  `pub` and `sub`.",
    examples: Examples::Topology {
        bad: "components:
  - name: a
    gates:
      - outbox: push
      - inbox: pull
  - name: b
    gates:
      - outbox: push
      - inbox: pull
connections:
  - [a.outbox, b.inbox]
  - [b.outbox, a.inbox]
",
        good: "components:
  - name: a
    gates:
      - outbox: push
      - inbox: sub
  - name: b
    gates:
      - outbox: pub
      - inbox: pull
connections:
  - [a.outbox, b.inbox]
  - [b.outbox, a.inbox]
",
    },
};

/// SCL0709.
pub(crate) const PUBLISHERS: Rule = Rule {
    code: "SCL0709",
    severity: Severity::Lint,
    title: "feedback loop of publishers",
    explanation: "Messages come back to the component that caused them. A control loop is built so on purpose. A \
                  component that publishes at once for each message it gets would flood the system; the lint is there \
                  to look for such.",
    examples: Examples::Topology {
        bad: "components:
  - name: a
    gates:
      - o: pub
      - i: sub
  - name: b
    gates:
      - o: pub
      - i: sub
connections:
  - [a.o, b.i]
  - [b.o, a.i]
",
        good: "components:
  - name: a
    gates:
      - o: pub
  - name: b
    gates:
      - i: sub
connections:
  - [a.o, b.i]
",
    },
};

/// A headline names no more components, and a problem shows no more connections.
const MOST: usize = 8;

/// The problem of one circle.
type Report = fn(&Draft<'_>, &[Step]) -> Diagnostic;

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let kinds: [(GateKind, Report); 3] =
        [(GateKind::Req, requests), (GateKind::Push, pushes), (GateKind::Pub, publishers)];
    for (kind, report) in kinds {
        for circle in ComponentGraph::of(draft, kind).circles() {
            problems.push(report(draft, &circle));
        }
    }
}

fn requests(draft: &Draft<'_>, circle: &[Step]) -> Diagnostic {
    let headline = format!("requests go round in a circle: {}", round(draft, circle));
    let waits = |step: &Step| format!("`{}` waits for `{}`", name(draft, step.from), name(draft, step.to));
    let found = REQUESTS.at(headline, place(draft, &circle[0]), waits(&circle[0]));
    others(draft, found, circle, waits)
        .help("let one side publish what the other asks for")
        .help("or send the answer later with a pub/sub pair")
        .help(
            "if no component asks while it answers, write\n`# scl: allow(SCL0707) reason` above one of the connections",
        )
        .note("if each component asks the next one while it answers, all of them wait for ever")
}

fn pushes(draft: &Draft<'_>, circle: &[Step]) -> Diagnostic {
    let headline = format!("push gates form a circle: {}", round(draft, circle));
    let label = |step: &Step| pushed(draft, step);
    let found = PUSHES.at(headline, place(draft, &circle[0]), label(&circle[0]));
    others(draft, found, circle, label).help("make one of the links `pub`/`sub`, which drops instead of waiting")
}

/// What happens on a connection whose queue is full.
fn pushed(draft: &Draft<'_>, step: &Step) -> String {
    let (from, to) = (name(draft, step.from), name(draft, step.to));
    let sink = draft.links[step.link].flow.map(|(_, sink)| draft.gates[sink].options.when_full);
    match sink {
        Some(WhenFull::Wait) => format!("`{from}` waits while the queue of `{to}` is full"),
        _ => format!("work of `{from}` is lost while the queue of `{to}` is full"),
    }
}

fn publishers(draft: &Draft<'_>, circle: &[Step]) -> Diagnostic {
    let headline = format!("publishers form a loop: {}", round(draft, circle));
    let found = PUBLISHERS.at(headline, place(draft, &circle[0]), "");
    others(draft, found, circle, |_| String::new()).note(
        "fine for a control loop; a component that publishes at once for each message it gets would flood the system",
    )
}

fn others(draft: &Draft<'_>, found: Diagnostic, circle: &[Step], label: impl Fn(&Step) -> String) -> Diagnostic {
    circle[1..].iter().take(MOST).fold(found, |found, step| found.label(place(draft, step), label(step)))
}

/// `` `a` -> `b` -> `a` ``.
fn round(draft: &Draft<'_>, circle: &[Step]) -> String {
    let mut names: Vec<String> = circle.iter().take(MOST).map(|step| format!("`{}`", name(draft, step.from))).collect();
    if circle.len() > MOST {
        names.push(format!("{} more", circle.len() - MOST));
    }
    names.push(format!("`{}`", name(draft, circle[0].from)));
    names.join(" -> ")
}

fn name<'m>(draft: &Draft<'m>, component: usize) -> &'m str {
    &draft.components[component].model.name.value
}

fn place(draft: &Draft<'_>, step: &Step) -> Span {
    draft.links[step.link].model.span
}

#[cfg(test)]
mod tests {
    use super::{PUBLISHERS, PUSHES, REQUESTS};
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn cycle_of_requests() {
        rule_example(
            &REQUESTS,
            expect![[r#"
            error: [SCL0707] requests go round in a circle: `arbiter` -> `power` -> `arbiter`
              --> topology.yaml:11:5
               |
            11 |   - [arbiter.power, power.status]
               |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ `arbiter` waits for `power`
            12 |   - [power.mission, arbiter.mission]
               |     -------------------------------- `power` waits for `arbiter`
               |
               = help: let one side publish what the other asks for
               = help: or send the answer later with a pub/sub pair
               = help: if no component asks while it answers, write
                       `# scl: allow(SCL0707) reason` above one of the connections
               = note: if each component asks the next one while it answers, all of them wait for ever
        "#]],
        );
    }

    #[test]
    fn cycle_of_push_gates() {
        rule_example(
            &PUSHES,
            expect![[r#"
            warning: [SCL0708] push gates form a circle: `a` -> `b` -> `a`
              --> topology.yaml:11:5
               |
            11 |   - [a.outbox, b.inbox]
               |     ^^^^^^^^^^^^^^^^^^^ work of `a` is lost while the queue of `b` is full
            12 |   - [b.outbox, a.inbox]
               |     ------------------- work of `b` is lost while the queue of `a` is full
               |
               = help: make one of the links `pub`/`sub`, which drops instead of waiting
        "#]],
        );
    }

    #[test]
    fn feedback_loop_of_publishers() {
        rule_example(
            &PUBLISHERS,
            expect![[r#"
            warning: [SCL0709] publishers form a loop: `a` -> `b` -> `a`
              --> topology.yaml:11:5
               |
            11 |   - [a.o, b.i]
               |     ^^^^^^^^^^
            12 |   - [b.o, a.i]
               |     ----------
               |
               = note: fine for a control loop; a component that publishes at once for each message it gets would flood the system
        "#]],
        );
    }
}
