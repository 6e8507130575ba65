//! Messages that come back to the component that sent them. SCL0708: a circle of push gates that may lose work.
//! SCL0709, a lint: a loop with a `pub` gate in it.

use super::circles::{self, Circle, Graph, Step, place};
use super::draft::Draft;
use super::waits;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::topology::GateKind;

/// SCL0708.
pub(crate) const PUSHES: Rule = Rule {
    code: "SCL0708",
    severity: Severity::Warning,
    title: "cycle of push gates",
    explanation: "Push gates form a circle, and the file does not say what happens when one of its queues is full: by \
                  default the oldest message is dropped, which loses work. Make one of the links `pub` and `sub`, or \
                  write `when_full` at one of the `pull` gates.",
    example: " components:
   - name: a
     gates:
       - outbox: push
-      - inbox: pull
+      - inbox: sub
   - name: b
     gates:
-      - outbox: push
+      - outbox: pub
       - inbox: pull
 connections:
   - [a.outbox, b.inbox]
   - [b.outbox, a.inbox]
",
};

/// SCL0709.
pub(crate) const LOOP: Rule = Rule {
    code: "SCL0709",
    severity: Severity::Lint,
    title: "feedback loop",
    explanation: "Messages come back to the component that caused them. Control loops are built like this on purpose. \
                  But a component that immediately sends a message for each one it receives would flood the system, \
                  and messages would be lost when a queue is full. The lint helps to find such components.",
    example: " components:
   - name: a
     gates:
       - o: pub
-      - i: sub
   - name: b
     gates:
-      - o: pub
       - i: sub
 connections:
   - [a.o, b.i]
-  - [b.o, a.i]
",
};

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let pushes = circles(draft, &[GateKind::Push]);
    let lossy = pushes.iter().filter(|circle| !circle.steps.iter().any(|step| is_decided(draft, step)));
    problems.extend(lossy.map(|circle| work(draft, circle)));
    let loops = circles(draft, &[GateKind::Pub, GateKind::Push]);
    let mixed = loops.iter().filter(|circle| circle.steps.iter().any(|step| is_published(draft, step)));
    // A circle in which every component waits is a deadlock, which another rule reports.
    let waits = |step: &Step| draft.links[step.link].flow.is_some_and(|(from, to)| waits::can_wait(draft, from, to));
    let open = mixed.filter(|circle| !circle.steps.iter().all(waits));
    problems.extend(open.map(|circle| messages(draft, circle)));
}

fn circles(draft: &Draft<'_>, kinds: &[GateKind]) -> Vec<Circle> {
    let is_one = |source: usize| draft.gates[source].kind.is_some_and(|kind| kinds.contains(&kind));
    let flows = draft.flows().filter(|&(_, source, _)| is_one(source));
    let steps = flows.map(|(link, source, sink)| waits::step(draft, link, source, sink));
    Graph::new(draft.components.len(), steps).circles(|_| true)
}

/// Whether the file says what a full queue does.
fn is_decided(draft: &Draft<'_>, step: &Step) -> bool {
    draft.links[step.link].flow.is_some_and(|(_, sink)| draft.gates[sink].option("when_full").is_some())
}

fn is_published(draft: &Draft<'_>, step: &Step) -> bool {
    draft.links[step.link].flow.is_some_and(|(source, _)| draft.gates[source].kind == Some(GateKind::Pub))
}

fn work(draft: &Draft<'_>, Circle { steps, .. }: &Circle) -> Diagnostic {
    let path = |step: &Step| draft.links[step.link].flow.map_or(String::new(), |(_, sink)| draft.path(sink));
    let label = |step: &Step| format!("work is lost while the queue of `{}` is full", path(step));
    let headline = format!("push gates form a circle: {}", circles::round(draft, steps));
    PUSHES
        .at(headline, place(draft, &steps[0]), label(&steps[0]))
        .labels(steps[1..].iter().map(|step| (place(draft, step), label(step))))
        .help("make one of the links `pub` and `sub`")
        .help(format!("or say that losing work is fine: `when_full: drop_oldest` at `{}`", path(&steps[0])))
}

fn messages(draft: &Draft<'_>, Circle { steps, .. }: &Circle) -> Diagnostic {
    let headline = format!("messages go round in a loop: {}", circles::round(draft, steps));
    let others = steps[1..].iter().map(|step| (place(draft, step), ""));
    LOOP.at(headline, place(draft, &steps[0]), "").labels(others).note(
        "fine for a control loop; a component that sends at once for each message it receives would flood the system",
    )
}

#[cfg(test)]
mod tests {
    use super::{LOOP, PUSHES};
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn cycle_of_push_gates() {
        rule_example(
            &PUSHES,
            expect![[r#"
            warning: [SCL0708] push gates form a circle: `a` -> `b` -> `a`
              --> topology.yaml:11:5
               |
            11 |   - [a.outbox, b.inbox]
               |     ^^^^^^^^^^^^^^^^^^^ work is lost while the queue of `b.inbox` is full
            12 |   - [b.outbox, a.inbox]
               |     ------------------- work is lost while the queue of `a.inbox` is full
               |
               = help: make one of the links `pub` and `sub`
               = help: or say that losing work is fine: `when_full: drop_oldest` at `b.inbox`
        "#]],
        );
    }

    #[test]
    fn feedback_loop() {
        rule_example(
            &LOOP,
            expect![[r#"
            warning: [SCL0709] messages go round in a loop: `a` -> `b` -> `a`
              --> topology.yaml:11:5
               |
            11 |   - [a.o, b.i]
               |     ^^^^^^^^^^
            12 |   - [b.o, a.i]
               |     ----------
               |
               = note: fine for a control loop; a component that sends at once for each message it receives would flood the system
        "#]],
        );
    }
}
