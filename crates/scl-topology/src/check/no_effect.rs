//! SCL0413: an option that changes nothing: `backpressure` without a receiver that waits, `share` with one puller,
//! `codec` at a gate that carries bytes.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::topology::{Payload, WhenFull};
use scl_text::list::listed;

/// SCL0413.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0413",
    severity: Severity::Warning,
    title: "option without effect",
    explanation: "The option changes nothing in this system: no receiver of a gate with `backpressure: true` waits, a \
                  gate with `share: true` has one puller, or a gate with a `codec` has no type. The system does not do \
                  what the file seems to say. Remove the option, or change the other end.",
    example: " components:
   - name: sensor
     gates:
       - measurements: {pub: Measurement, backpressure: true}
   - name: recorder
     gates:
-      - measurements: {sub: Measurement}
+      - measurements: {sub: Measurement, when_full: wait}
 connections:
   - [sensor.measurements, recorder.measurements]
",
};

/// Checks only files without errors: otherwise, the option or connection that seems to be missing may be one that could
/// not be read.
pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    if problems.has_errors() || draft.model.connections_unread {
        return;
    }
    let mut receivers = vec![Vec::new(); draft.gates.len()];
    for (_, source, sink) in draft.flows() {
        receivers[source].push(sink);
    }
    for (at, gate) in draft.gates.iter().enumerate() {
        let waits = |&receiver: &usize| draft.gates[receiver].options.when_full == WhenFull::Wait;
        let receivers = receivers[at].as_slice();
        if gate.options.backpressure && !receivers.is_empty() && !receivers.iter().any(waits) {
            problems.extend(without_waiting(draft, at, receivers));
        }
        if let (true, [puller]) = (gate.options.share, receivers) {
            problems.extend(without_sharing(draft, at, *puller));
        }
        if gate.payload == Some(Payload::Bytes) {
            problems.extend(without_type(draft, at));
        }
    }
}

fn without_waiting(draft: &Draft<'_>, gate: usize, receivers: &[usize]) -> Option<Diagnostic> {
    let reason = match receivers {
        [_] => "its receiver does not wait",
        _ => "none of its receivers waits",
    };
    let names = listed(receivers.iter().map(|&receiver| draft.path(receiver)));
    let found = report(draft, gate, "backpressure", reason)?.note(format!("receivers: {names}"));
    Some(match receivers {
        &[receiver] => {
            let text = format!("or let `{}` wait: `when_full: wait`", draft.path(receiver));
            found.suggest(text, [draft.with_option(receiver, "when_full", "wait")])
        }
        _ => found.help("a receiver waits with `when_full: wait`"),
    })
}

fn without_sharing(draft: &Draft<'_>, gate: usize, puller: usize) -> Option<Diagnostic> {
    let found = report(draft, gate, "share", "it has one puller")?;
    let found = found.help("the work is shared among several pullers, each with a connection of its own");
    Some(found.note(format!("its puller: `{}`", draft.path(puller))))
}

fn without_type(draft: &Draft<'_>, gate: usize) -> Option<Diagnostic> {
    Some(report(draft, gate, "codec", "the gate carries bytes")?.help("a codec is for gates that have a type"))
}

fn report(draft: &Draft<'_>, gate: usize, key: &str, reason: &str) -> Option<Diagnostic> {
    let option = draft.gates[gate].option(key)?;
    let written = format!("{key}: {}", option.value.value);
    let headline = format!("`{written}` of `{}` has no effect: {reason}", draft.path(gate));
    let found = RULE.at(headline, option.key.span.to(option.value.span), "");
    Some(match draft.without_option(gate, key) {
        Some(edit) => found.suggest(format!("remove `{written}`"), [edit]),
        None => found,
    })
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn option_without_effect() {
        rule_example(
            &RULE,
            expect![[r#"
                warning: [SCL0413] `backpressure: true` of `sensor.measurements` has no effect: its receiver does not wait
                 --> topology.yaml:4:42
                  |
                4 |       - measurements: {pub: Measurement, backpressure: true}
                  |                                          ^^^^^^^^^^^^^^^^^^
                  |
                  = help: remove `backpressure: true`
                  = help: or let `recorder.measurements` wait: `when_full: wait`
                  = note: receivers: `recorder.measurements`
            "#]],
        );
    }
}
