//! Queues that are longer than the age of messages allows: SCL1804.

use super::draft::Draft;
use super::time::{MOST_NAMED, promise, promise_place, written};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use scl_text::duration::text;
use std::collections::HashSet;
use std::time::Duration;

/// SCL1804.
pub(crate) const TOO_OLD: Rule = Rule {
    code: "SCL1804",
    severity: Severity::Warning,
    title: "queue for messages that are too old",
    explanation: "As often as the senders promise to send, the messages in a full queue become older than the \
                  receiver's `max_age` before the program receives them, so they wait only to be dropped. Such a queue \
                  drops messages late instead of at once. Give it only as many messages as come in that time.",
    example: " components:
   - name: gyro
     gates:
       - rates: {pub: Rates, rate: 100Hz}
   - name: autopilot
     gates:
-      - rates: {sub: Rates, queue: 20, max_age: 50ms}
+      - rates: {sub: Rates, queue: 6, max_age: 50ms}
 connections:
   - [gyro.rates, autopilot.rates]
",
};

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    // A promise that seems to be too rare may be one that could not be read.
    if problems.has_errors() {
        return;
    }
    // The components of a kind share their gates, and what is wrong with them.
    let mut told = HashSet::new();
    for (sink, senders) in draft.links_by_gate().into_iter().enumerate() {
        let Some(max_age) = draft.gates[sink].options.max_age else { continue };
        let senders: Vec<usize> = senders.into_iter().map(|(_, source)| source).collect();
        if let Some(problem) = too_old(draft, sink, &senders, max_age)
            && told.insert(draft.shared(sink))
        {
            problems.push(problem);
        }
    }
}

fn too_old(draft: &Draft<'_>, sink: usize, senders: &[usize], max_age: Duration) -> Option<Diagnostic> {
    let sink = draft.shared(sink);
    // The default is long enough for most gates, and nobody has chosen it.
    let place = written(&draft.gates[sink], "queue")?;
    let queue = u128::from(draft.gates[sink].options.queue);
    // In a time of five periods come six messages, one at each end of it.
    let come = |source: &usize| promise(draft, *source).map(|period| max_age.as_nanos() / period.as_nanos() + 1);
    let useful = senders.iter().map(come).sum::<Option<u128>>()?;
    if useful == 0 || queue <= useful {
        return None;
    }
    let receiver = draft.shared_path(sink);
    let mut named: Vec<usize> = senders.iter().map(|source| draft.shared(*source)).collect();
    named.sort_unstable();
    named.dedup();
    let promises = named.iter().take(MOST_NAMED).filter_map(|source| {
        let period = promise(draft, *source)?;
        Some((promise_place(draft, *source), format!("one in {}", text(period))))
    });
    let old = queue - useful;
    let found = TOO_OLD
        .at(
            format!(
                "a full queue of `{receiver}` has messages that are older than {}: {old} of {queue}",
                text(max_age)
            ),
            place,
            "",
        )
        .labels(written(&draft.gates[sink], "max_age").map(|place| (place, "what is older is dropped".to_owned())))
        .labels(promises);
    Some(found.suggest(
        format!("write `queue: {useful}` at `{receiver}`: that is how many come in {}", text(max_age)),
        [draft.with_option(sink, "queue", &useful.to_string())],
    ))
}

#[cfg(test)]
mod tests {
    use super::TOO_OLD;
    use crate::check::testing::{advice_of_pairs, rule_example};
    use expect_test::expect;

    #[test]
    fn messages_wait_only_to_be_dropped() {
        rule_example(
            &TOO_OLD,
            expect![[r#"
                warning: [SCL1804] a full queue of `autopilot.rates` has messages that are older than 50ms: 14 of 20
                 --> topology.yaml:7:29
                  |
                4 |       - rates: {pub: Rates, rate: 100Hz}
                  |                             ----------- one in 10ms
                ...
                7 |       - rates: {sub: Rates, queue: 20, max_age: 50ms}
                  |                             ^^^^^^^^^  ------------- what is older is dropped
                  |
                  = help: write `queue: 6` at `autopilot.rates`: that is how many come in 50ms
            "#]],
        );
    }

    #[test]
    fn ages_and_queues_in_many_shapes() {
        let file = |sender: &str, receiver: &str| {
            format!(
                "kinds:\n  - {{name: eye, gates: [{{o: {{{sender}}}}}]}}\ncomponents:\n  - {{name: a, kind: eye}}\n  - \
                 {{name: b, kind: eye}}\n  - {{name: c, gates: [{{one: {{{receiver}}}}}, {{two: \
                 {{{receiver}}}}}]}}\nconnections:\n  - [a.o, c.one]\n  - [each eye.o, c.two]\n"
            )
        };
        let pairs = [
            ("pub: T, rate: 100Hz", "sub: T, queue: 7, max_age: 50ms"),
            ("pub: T, rate: 100Hz", "sub: T, queue: 6, max_age: 50ms"),
            ("pub: T, rate: 100Hz", "sub: T, queue: 13, max_age: 50ms"),
            ("pub: T, period: 1s", "sub: T, queue: 2, max_age: 1ms"),
            ("pub: T, period: 1s", "sub: T, queue: 1, max_age: 1ms"),
            ("pub: T, rate: 1000000Hz", "sub: T, queue: 1000000, max_age: 24h"),
            ("push: T, period: 1s, queue: 9", "pull: T, queue: 9, max_age: 1s"),
            ("pub: T, rate: 100Hz", "sub: T, max_age: 50ms"),
            ("pub: T", "sub: T, queue: 1000, max_age: 50ms"),
        ];
        let told = advice_of_pairs(&[&TOO_OLD], &pairs, file);
        expect![[r#"
            pub: T, rate: 100Hz -> sub: T, queue: 7, max_age: 50ms: a full queue of `c.one` has messages that are older than 50ms: 1 of 7 [write `queue: 6` at `c.one`: that is how many come in 50ms]
            pub: T, rate: 100Hz -> sub: T, queue: 6, max_age: 50ms: 
            pub: T, rate: 100Hz -> sub: T, queue: 13, max_age: 50ms: a full queue of `c.one` has messages that are older than 50ms: 7 of 13 [write `queue: 6` at `c.one`: that is how many come in 50ms]; a full queue of `c.two` has messages that are older than 50ms: 1 of 13 [write `queue: 12` at `c.two`: that is how many come in 50ms]
            pub: T, period: 1s -> sub: T, queue: 2, max_age: 1ms: a full queue of `c.one` has messages that are older than 1ms: 1 of 2 [write `queue: 1` at `c.one`: that is how many come in 1ms]
            pub: T, period: 1s -> sub: T, queue: 1, max_age: 1ms: 
            pub: T, rate: 1000000Hz -> sub: T, queue: 1000000, max_age: 24h: 
            push: T, period: 1s, queue: 9 -> pull: T, queue: 9, max_age: 1s: 
            pub: T, rate: 100Hz -> sub: T, max_age: 50ms: 
            pub: T -> sub: T, queue: 1000, max_age: 50ms: 
        "#]].assert_eq(&told);
    }
}
