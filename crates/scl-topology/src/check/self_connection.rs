//! SCL0507: a gate connected to itself. SCL0508: a component that waits for itself. SCL0509: one that subscribes to
//! itself.

use super::deadlock::drop_messages;
use super::draft::{Draft, Link};
use super::fitting_gate::FittingGates;
use super::waits::{self, Wait, Waiting};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity, removal};
use crate::topology::GateKind;
use scl_text::list::all_of;
use std::collections::HashSet;

/// SCL0507.
pub(crate) const ITSELF: Rule = Rule {
    code: "SCL0507",
    severity: Severity::Error,
    title: "gate connected to itself",
    explanation: "Both ends of the connection are the same gate. A gate either sends or receives, so it cannot be \
                  connected to itself; another gate was meant.",
    example: " components:
   - name: controller
     gates:
       - commands: rep
+  - name: ui
+    gates:
+      - commands: req
 connections:
-  - [controller.commands, controller.commands]
+  - [controller.commands, ui.commands]
",
};

/// SCL0508.
pub(crate) const WAITS_FOR_ITSELF: Rule = Rule {
    code: "SCL0508",
    severity: Severity::Error,
    title: "component waits for itself",
    explanation: "A component that sends a request to itself waits for an answer that only it can give; one that sends \
                  itself messages with `backpressure: true` and `when_full: wait` waits for room in a queue that only \
                  it can empty. Call a function inside the component, or keep the value in it.",
    example: " components:
   - name: planner
     gates:
       - ask: req
+  - name: map
+    gates:
       - answer: rep
 connections:
-  - [planner.ask, planner.answer]
+  - [planner.ask, map.answer]
",
};

/// SCL0509.
pub(crate) const HEARS_ITSELF: Rule = Rule {
    code: "SCL0509",
    severity: Severity::Warning,
    title: "component subscribes to itself",
    explanation: "A component receives its own messages: each leaves the process and comes back. Keeping the value in \
                  the component is faster and simpler. If the design needs it, allow the warning with a reason.",
    example: " components:
   - name: planner
     gates:
       - plan: pub
-      - old_plan: sub
+  - name: pilot
+    gates:
+      - plan: sub
 connections:
-  - [planner.plan, planner.old_plan]
+  - [planner.plan, pilot.plan]
",
};

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    let is_loop = |link: &Link<'_>| link.ends[0].filter(|_| link.ends[0] == link.ends[1]);
    let loops = draft.links.iter().enumerate().filter_map(|(at, link)| Some((at, is_loop(link)?)));
    let loops: Vec<(usize, usize)> = loops.collect();
    let fitting = if loops.is_empty() { FittingGates::default() } else { FittingGates::of(draft) };
    for (link, gate) in loops {
        let partners = fitting.for_gate(draft, gate);
        problems.push(itself(draft, link, gate, &partners));
        partners.into_iter().for_each(|gate| draft.gates[gate].named = true);
    }
    let waits: Vec<Wait> = waits::all(draft).into_iter().filter(Wait::is_for_itself).collect();
    let waiting: HashSet<usize> = waits.iter().flat_map(|wait| &wait.steps).map(|step| step.link).collect();
    let waiting_gates = Waiting::of(draft);
    problems.extend(waits.iter().filter_map(|wait| waits_for_itself(draft, wait, &waiting_gates)));
    for (link, source, sink) in draft.flows().filter(|(link, ..)| !waiting.contains(link)) {
        if draft.component_name(source) == draft.component_name(sink) {
            problems.push(hears_itself(draft, link, source));
        }
    }
}

fn itself(draft: &Draft<'_>, link: usize, gate: usize, partners: &[usize]) -> Diagnostic {
    let model = draft.links[link].model;
    let (path, place) = (draft.path(gate), model.ends[1].span);
    let found = ITSELF.at(format!("gate `{path}` is connected to itself"), model.span, "both ends are the same gate");
    let found = partners.iter().fold(found, |found, &partner| {
        let other = draft.path(partner);
        let edit = Edit::new(place, draft.sources.quoted_as(place, &other));
        found.suggest(format!("write `[{path}, {other}]`"), [edit])
    });
    let others = draft.gates[gate].uses > 2;
    let removed = removal(draft.sources.file(model.span.file), model.span).filter(|_| others);
    let found = match removed {
        Some(removed) => found.suggest("remove this connection", [removed]),
        None => found,
    };
    found.otherwise("the two ends must be different gates")
}

fn waits_for_itself(draft: &Draft<'_>, wait: &Wait, waiting: &Waiting) -> Option<Diagnostic> {
    let first = wait.steps[0].link;
    let (source, sink) = draft.links[first].flow?;
    let name = draft.component_name(source);
    if draft.gates[source].kind == Some(GateKind::Req) {
        let label = format!("`{name}` would wait for an answer that only `{name}` can give");
        let headline = format!("component `{name}` sends requests to itself");
        let found = WAITS_FOR_ITSELF.at(headline, draft.links[first].model.span, label);
        return Some(removed(draft, found, first, "call a function inside the component"));
    }
    let label = |sink| {
        format!("`{name}` waits while the queue of `{}` is full, and only `{name}` can empty it", draft.path(sink))
    };
    let headline = format!("component `{name}` waits for itself");
    let mut found = WAITS_FOR_ITSELF.at(headline, draft.links[first].model.span, label(sink));
    for step in &wait.steps[1..] {
        let (_, sink) = draft.links[step.link].flow?;
        found = found.label(draft.links[step.link].model.span, label(sink));
    }
    let found = removed(draft, found, first, KEEP);
    Some(drop_messages(draft, found, "or ", sink, waiting))
}

const KEEP: &str = "keep the value in the component";

fn hears_itself(draft: &Draft<'_>, link: usize, source: usize) -> Diagnostic {
    let name = draft.component_name(source);
    let is_work = draft.gates[source].kind == Some(GateKind::Push);
    let does = if is_work { "pulls its own work" } else { "subscribes to its own messages" };
    let span = draft.links[link].model.span;
    let found = HEARS_ITSELF.at(format!("component `{name}` {does}"), span, "leaves the process and comes back");
    removed(draft, found, link, KEEP)
}

/// Suggests to do without a connection, and without those of its gates that have no other one.
fn removed(draft: &Draft<'_>, found: Diagnostic, link: usize, instead: &str) -> Diagnostic {
    let unused = draft.links[link].ends.into_iter().flatten().filter(|gate| draft.gates[*gate].uses == 1);
    let unused: Vec<usize> = unused.collect();
    let places = unused.iter().map(|&gate| draft.gates[gate].model.span).chain([draft.links[link].model.span]);
    let edits: Option<Vec<Edit>> = places.map(|place| removal(draft.sources.file(place.file), place)).collect();
    let paths: Vec<String> = unused.iter().map(|&gate| draft.path(gate)).collect();
    let what = match paths.as_slice() {
        [] => "this connection".to_owned(),
        [gate] => format!("this connection and the gate `{gate}`"),
        gates => format!("this connection and the gates {}", all_of(gates)),
    };
    let found = match edits {
        Some(edits) => found.suggest(format!("{instead}, and remove {what}"), edits),
        None => found,
    };
    found.otherwise(format!("{instead}, and remove {what}"))
}

#[cfg(test)]
mod tests {
    use super::{HEARS_ITSELF, ITSELF, WAITS_FOR_ITSELF};
    use crate::check::testing::{example, rule_example};
    use expect_test::expect;

    #[test]
    fn gate_connected_to_itself() {
        rule_example(
            &ITSELF,
            expect![[r#"
            error: [SCL0507] gate `controller.commands` is connected to itself
             --> topology.yaml:6:5
              |
            6 |   - [controller.commands, controller.commands]
              |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ both ends are the same gate
              |
              = help: the two ends must be different gates
        "#]],
        );
    }

    #[test]
    fn component_waits_for_itself() {
        rule_example(
            &WAITS_FOR_ITSELF,
            expect![[r#"
                error: [SCL0508] component `planner` sends requests to itself
                 --> topology.yaml:7:5
                  |
                7 |   - [planner.ask, planner.answer]
                  |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ `planner` would wait for an answer that only `planner` can give
                  |
                  = help: call a function inside the component, and remove this connection and the gates `planner.ask` and `planner.answer`
            "#]],
        );
    }

    #[test]
    fn component_waits_for_room_in_its_own_queue() {
        let yaml = "components:
  - name: planner
    gates:
      - plan: {pub: Plan, backpressure: true}
      - old_plan: {sub: Plan, when_full: wait}
connections:
  - [planner.plan, planner.old_plan]
";
        example(
            "SCL0508",
            yaml,
            expect![[r#"
                error: [SCL0508] component `planner` waits for itself
                 --> topology.yaml:7:5
                  |
                7 |   - [planner.plan, planner.old_plan]
                  |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ `planner` waits while the queue of `planner.old_plan` is full, and only `planner` can empty it
                  |
                  = help: keep the value in the component, and remove this connection and the gates `planner.plan` and `planner.old_plan`
                  = help: or let `planner.old_plan` drop messages: `when_full: drop_oldest`, and remove `backpressure` from `planner.plan`
            "#]],
        );
    }

    #[test]
    fn component_subscribes_to_itself() {
        rule_example(
            &HEARS_ITSELF,
            expect![[r#"
                warning: [SCL0509] component `planner` subscribes to its own messages
                 --> topology.yaml:7:5
                  |
                7 |   - [planner.plan, planner.old_plan]
                  |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ leaves the process and comes back
                  |
                  = help: keep the value in the component, and remove this connection and the gates `planner.plan` and `planner.old_plan`
            "#]],
        );
    }
}
