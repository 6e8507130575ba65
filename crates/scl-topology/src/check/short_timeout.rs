//! SCL0414: a request that times out before the replier's own requests can.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::topology::GateKind;
use scl_text::duration;

/// SCL0414.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0414",
    severity: Severity::Warning,
    title: "timeout shorter than that of a nested call",
    explanation: "The replier also makes requests, and one of them may take longer than the requester waits. If the \
                  replier makes it before it answers, the requester gives up while the reply is still possible, and \
                  never learns which call was late. Make the outer timeout longer, or the inner one shorter. If the \
                  two requests are unrelated, allow the warning.",
    example: " components:
   - name: user_interface
     gates:
-      - commands: {req: Command -> Status, timeout: 500ms}
+      - commands: {req: Command -> Status, timeout: 3s}
   - name: controller
     gates:
       - commands: {rep: Command -> Status}
       - map: {req: Area -> Map, timeout: 2s}
   - name: map_server
     gates:
       - map: {rep: Area -> Map}
 connections:
   - [user_interface.commands, controller.commands]
   - [controller.map, map_server.map]
",
};

/// Checks only files without errors: otherwise, a timeout that seems to be missing may be one that could not be read.
pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    if problems.has_errors() {
        return;
    }
    let slowest = slowest_requests(draft);
    for (_, source, sink) in draft.flows() {
        let (requester, replier) = (&draft.gates[source], draft.gates[sink].component);
        if requester.kind != Some(GateKind::Req) || requester.component == replier {
            continue;
        }
        let Some(inner) = slowest[replier] else { continue };
        if requester.options.timeout < draft.gates[inner].options.timeout {
            problems.push(report(draft, source, sink, inner));
        }
    }
}

/// For each component, its connected `req` gate with the longest timeout.
fn slowest_requests(draft: &Draft<'_>) -> Vec<Option<usize>> {
    let mut slowest: Vec<Option<usize>> = vec![None; draft.components.len()];
    for (_, source, _) in draft.flows() {
        let gate = &draft.gates[source];
        let so_far = &mut slowest[gate.component];
        let is_slower = so_far.is_none_or(|other| draft.gates[other].options.timeout < gate.options.timeout);
        if gate.kind == Some(GateKind::Req) && is_slower {
            *so_far = Some(source);
        }
    }
    slowest
}

fn report(draft: &Draft<'_>, outer: usize, replier: usize, inner: usize) -> Diagnostic {
    let [short, long] = [outer, inner].map(|gate| duration::text(draft.gates[gate].options.timeout));
    let (outer_path, inner_path) = (draft.path(outer), draft.path(inner));
    let headline = format!("`{outer_path}` times out after {short}, before `{inner_path}` does after {long}");
    let place = |gate: usize| match draft.gates[gate].option("timeout") {
        Some(option) => option.key.span.to(option.value.span),
        None => draft.gates[gate].model.span,
    };
    let default = |gate: usize| if draft.gates[gate].option("timeout").is_none() { ", the default" } else { "" };
    RULE.at(headline, place(outer), format!("gives up after {short}{}", default(outer)))
        .label(draft.gates[replier].model.name.span, "answers this request")
        .label(place(inner), format!("the replier makes this request, which may take {long}{}", default(inner)))
        .help(format!(
            "the timeout of `{outer_path}` must be longer than {long}, or that of `{inner_path}` shorter than {short}"
        ))
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn timeout_shorter_than_that_of_a_call_behind_it() {
        rule_example(
            &RULE,
            expect![[r#"
                warning: [SCL0414] `user_interface.commands` times out after 500ms, before `controller.map` does after 2s
                 --> topology.yaml:4:44
                  |
                4 |       - commands: {req: Command -> Status, timeout: 500ms}
                  |                                            ^^^^^^^^^^^^^^ gives up after 500ms
                ...
                7 |       - commands: {rep: Command -> Status}
                  |         -------- answers this request
                8 |       - map: {req: Area -> Map, timeout: 2s}
                  |                                 ----------- the replier makes this request, which may take 2s
                  |
                  = help: the timeout of `user_interface.commands` must be longer than 2s, or that of `controller.map` shorter than 500ms
            "#]],
        );
    }
}
