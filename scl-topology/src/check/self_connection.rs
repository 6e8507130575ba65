//! SCL0507: a gate connected to itself. SCL0508: a component that asks itself. SCL0509: one that subscribes to itself.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::topology::GateKind;

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    for link in &draft.links {
        if let [Some(a), Some(b)] = link.ends
            && a == b
        {
            let headline = format!("gate `{}` is connected to itself", draft.path(a));
            let found = Diagnostic::error("SCL0507", headline, link.model.span, "both ends are the same gate")
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
            Diagnostic::error("SCL0508", headline, span, label)
                .help("call a function inside the component instead")
                .note("a component with one thread stops here for ever")
        }
        kind => {
            let does =
                if kind == Some(GateKind::Push) { "pulls its own work" } else { "subscribes to its own messages" };
            let headline = format!("component `{name}` {does}");
            Diagnostic::warning("SCL0509", headline, span, "leaves the process and comes back")
                .help("keep the value in the component")
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::example;
    use expect_test::expect;

    #[test]
    fn gate_connected_to_itself() {
        let yaml = r#"
components:
  - name: controller
    gates:
      - commands: rep
connections:
  - [controller.commands, controller.commands]
"#;
        example(
            "SCL0507",
            yaml.trim_start(),
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
        let yaml = r#"
components:
  - name: planner
    gates:
      - ask: req
      - answer: rep
connections:
  - [planner.ask, planner.answer]
"#;
        example(
            "SCL0508",
            yaml.trim_start(),
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
        let yaml = r#"
components:
  - name: planner
    gates:
      - plan: pub
      - old_plan: sub
connections:
  - [planner.plan, planner.old_plan]
"#;
        example(
            "SCL0509",
            yaml.trim_start(),
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
