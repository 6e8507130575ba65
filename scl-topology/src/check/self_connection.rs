//! SCL0507: a gate connected to itself. SCL0508: a component that asks itself. SCL0509: one that subscribes to itself.

use super::draft::Draft;
use crate::diagnostic::Severity;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::rule::{Examples, Rule};
use crate::topology::GateKind;

/// SCL0507.
pub(crate) const ITSELF: Rule = Rule {
    code: "SCL0507",
    severity: Severity::Error,
    title: "gate connected to itself",
    explanation: "Both ends of the connection are one gate. A gate either sends or receives, so it cannot talk to \
                  itself; another gate was meant.",
    examples: Examples::Topology {
        bad: "components:
  - name: controller
    gates:
      - commands: rep
connections:
  - [controller.commands, controller.commands]
",
        good: "components:
  - name: controller
    gates:
      - commands: rep
  - name: ui
    gates:
      - commands: req
connections:
  - [controller.commands, ui.commands]
",
    },
};

/// SCL0508.
pub(crate) const ASKS_ITSELF: Rule = Rule {
    code: "SCL0508",
    severity: Severity::Error,
    title: "component asks itself",
    explanation: "A component that asks itself waits for an answer that only it can give, and with one thread it waits \
                  for ever. Call a function inside the component instead.",
    examples: Examples::Topology {
        bad: "components:
  - name: planner
    gates:
      - ask: req
      - answer: rep
connections:
  - [planner.ask, planner.answer]
",
        good: "components:
  - name: planner
    gates:
      - ask: req
  - name: map
    gates:
      - answer: rep
connections:
  - [planner.ask, map.answer]
",
    },
};

/// SCL0509.
pub(crate) const HEARS_ITSELF: Rule = Rule {
    code: "SCL0509",
    severity: Severity::Warning,
    title: "component subscribes to itself",
    explanation: "A component receives what it sends itself: the message leaves the process and comes back. Keeping \
                  the value in the component is faster and simpler. Some designs want it; then allow it with a reason.",
    examples: Examples::Topology {
        bad: "components:
  - name: planner
    gates:
      - plan: pub
      - old_plan: sub
connections:
  - [planner.plan, planner.old_plan]
",
        good: "components:
  - name: planner
    gates:
      - plan: pub
  - name: pilot
    gates:
      - plan: sub
connections:
  - [planner.plan, pilot.plan]
",
    },
};

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    for link in &draft.links {
        if let [Some(a), Some(b)] = link.ends
            && a == b
        {
            let headline = format!("gate `{}` is connected to itself", draft.path(a));
            let found = ITSELF
                .at(headline, link.model.span, "both ends are the same gate")
                .help("the two ends must be different gates");
            problems.push(found);
        }
    }
    for (link, source, sink) in draft.flows() {
        if draft.component_name(source) == draft.component_name(sink) {
            problems.push(to_itself(draft, link, source));
        }
    }
}

fn to_itself(draft: &Draft<'_>, link: usize, source: usize) -> Diagnostic {
    let name = draft.component_name(source);
    let span = draft.links[link].model.span;
    match draft.gates[source].kind {
        Some(GateKind::Req) => {
            let headline = format!("component `{name}` sends requests to itself");
            let label = format!("`{name}` would wait for an answer that only `{name}` can give");
            ASKS_ITSELF
                .at(headline, span, label)
                .help("call a function inside the component instead")
                .note("a component with one thread stops here for ever")
        }
        kind => {
            let does =
                if kind == Some(GateKind::Push) { "pulls its own work" } else { "subscribes to its own messages" };
            let headline = format!("component `{name}` {does}");
            HEARS_ITSELF.at(headline, span, "leaves the process and comes back").help("keep the value in the component")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ASKS_ITSELF, HEARS_ITSELF, ITSELF};
    use crate::check::testing::rule_example;
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
    fn component_asks_itself() {
        rule_example(
            &ASKS_ITSELF,
            expect![[r#"
            error: [SCL0508] component `planner` sends requests to itself
             --> topology.yaml:7:5
              |
            7 |   - [planner.ask, planner.answer]
              |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ `planner` would wait for an answer that only `planner` can give
              |
              = help: call a function inside the component instead
              = note: a component with one thread stops here for ever
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
              = help: keep the value in the component
        "#]],
        );
    }
}
