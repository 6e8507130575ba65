//! SCL0410: a receiver that would make its sender wait, and a sender that never waits.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::topology::{GateKind, WhenFull};

/// SCL0410.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0410",
    severity: Severity::Error,
    title: "delivery options of the two ends conflict",
    explanation: "A receiver with `when_full: wait` makes its sender wait while its queue is full. That must not \
                  happen to a sender by surprise, so the sender allows it with `backpressure: true`. Allow it, or let \
                  the receiver lose messages.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: {pub: Measurement}
+      - measurements: {pub: Measurement, backpressure: true}
   - name: recorder
     gates:
       - measurements: {sub: Measurement, when_full: wait}
 connections:
   - [sensor.measurements, recorder.measurements]
",
};

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    // `when_full` at a replier is refused elsewhere, and a requester has no `backpressure` to set.
    let sends = |source: usize| matches!(draft.gates[source].kind, Some(GateKind::Pub | GateKind::Push));
    for (link, source, sink) in draft.flows().filter(|&(_, source, _)| sends(source)) {
        let waits = draft.gates[sink].options.when_full == WhenFull::Wait;
        if waits && !draft.gates[source].options.backpressure {
            problems.push(report(draft, link, source, sink));
        }
    }
}

fn report(draft: &Draft<'_>, link: usize, source: usize, sink: usize) -> Diagnostic {
    let (sender, receiver) = match draft.gates[source].kind {
        Some(GateKind::Push) => ("pusher", "puller"),
        _ => ("publisher", "subscriber"),
    };
    let headline = format!("`{}` would make `{}` wait, which it does not allow", draft.path(sink), draft.path(source));
    let option = draft.gates[sink].option("when_full");
    RULE.at(headline, draft.links[link].model.span, "")
        .label(draft.gates[source].declaration(), format!("never waits for a {receiver}"))
        .labels(option.map(|it| (it.key.span.to(it.value.span), format!("makes the {sender} wait"))))
        .suggest(
            format!("allow it on the {sender}: write `backpressure: true` at `{}`", draft.path(source)),
            [draft.with_option(source, "backpressure", "true")],
        )
        .suggest(
            format!("or let the {receiver} lose messages: write `when_full: drop_oldest` at `{}`", draft.path(sink)),
            [draft.with_option(sink, "when_full", "drop_oldest")],
        )
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn delivery_options_of_the_two_ends_do_not_fit() {
        rule_example(
            &RULE,
            expect![[r#"
                error: [SCL0410] `recorder.measurements` would make `sensor.measurements` wait, which it does not allow
                 --> topology.yaml:9:5
                  |
                4 |       - measurements: {pub: Measurement}
                  |                        ---------------- never waits for a subscriber
                ...
                7 |       - measurements: {sub: Measurement, when_full: wait}
                  |                                          --------------- makes the publisher wait
                8 | connections:
                9 |   - [sensor.measurements, recorder.measurements]
                  |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
                  |
                  = help: allow it on the publisher: write `backpressure: true` at `sensor.measurements`
                  = help: or let the subscriber lose messages: write `when_full: drop_oldest` at `recorder.measurements`
            "#]],
        );
    }
}
