//! What receivers need and senders promise: SCL1801 to SCL1803.

use super::draft::{Draft, DraftGate};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::source::Span;
use scl_text::duration::text;
use scl_text::list::listed;
use std::collections::{BTreeMap, HashSet};
use std::time::Duration;

/// SCL1801.
pub(crate) const TOO_SHORT: Rule = Rule {
    code: "SCL1801",
    severity: Severity::Error,
    title: "deadline shorter than the sender's period",
    explanation: "The receiver needs a message more often than the sender promises to send one, so it would miss its \
                  deadline all the time. Give the deadline room for more than one period, because each message may be \
                  a little late, or have the sender send more often.",
    example: " components:
   - name: gyro
     gates:
       - rates: {pub: Rates, rate: 100Hz}
   - name: autopilot
     gates:
-      - rates: {sub: Rates, deadline: 5ms}
+      - rates: {sub: Rates, deadline: 20ms}
 connections:
   - [gyro.rates, autopilot.rates]
",
};

/// SCL1802.
pub(crate) const NO_PROMISE: Rule = Rule {
    code: "SCL1802",
    severity: Severity::Warning,
    title: "deadline without a promise of the sender",
    explanation: "The receiver needs a message at least this often, and a sender does not say how often it sends: \
                  nobody can know before the system runs whether the deadline can be met. Write `rate` or `period` at \
                  the sender. If several pullers share the messages of a `push` gate, none of them is promised any.",
    example: " components:
   - name: gyro
     gates:
-      - rates: {pub: Rates}
+      - rates: {pub: Rates, rate: 100Hz}
   - name: autopilot
     gates:
       - rates: {sub: Rates, deadline: 20ms}
 connections:
   - [gyro.rates, autopilot.rates]
",
};

/// SCL1803.
pub(crate) const TWICE: Rule = Rule {
    code: "SCL1803",
    severity: Severity::Error,
    title: "both `rate` and `period`",
    explanation: "`rate: 100Hz` and `period: 10ms` are two ways to say the same. A gate has one of them.",
    example: " components:
   - name: gyro
     gates:
-      - rates: {pub: Rates, rate: 100Hz, period: 20ms}
+      - rates: {pub: Rates, rate: 100Hz}
",
};

/// How many senders a problem names.
pub(super) const MOST_NAMED: usize = 3;

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    for gate in 0..draft.gates.len() {
        problems.extend(twice(draft, gate));
    }
    // The components of a kind share their gates, and what is wrong with them.
    let mut seen = HashSet::new();
    // By receiver: the senders that promise nothing.
    let mut silent: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (sink, senders) in draft.links_by_gate().into_iter().enumerate() {
        let Some(deadline) = draft.gates[sink].options.deadline else { continue };
        for (_, source) in senders {
            let (sink, source) = (draft.shared(sink), draft.shared(source));
            match promise(draft, source) {
                _ if !seen.insert((sink, source)) => {}
                Some(period) if period > deadline => problems.push(too_short(draft, source, sink, period, deadline)),
                Some(_) => {}
                None => silent.entry(sink).or_default().push(source),
            }
        }
    }
    // A promise that seems to be missing may be one that could not be read.
    if !problems.has_errors() {
        problems.extend(silent.into_iter().map(|(sink, senders)| no_promise(draft, sink, &senders)));
    }
}

/// How long it takes at most until a peer gets the next message, if the gate says so.
pub(super) fn promise(draft: &Draft<'_>, source: usize) -> Option<Duration> {
    let options = &draft.gates[source].options;
    options.period.filter(|_| !options.share)
}

fn twice(draft: &Draft<'_>, gate: usize) -> Option<Diagnostic> {
    let [rate, period] = ["rate", "period"].map(|key| written(&draft.gates[gate], key));
    let (rate, period) = (rate?, period?);
    let found = TWICE
        .at(format!("`{}` has both `rate` and `period`", draft.shared_path(gate)), period, "")
        .label(rate, "says how often, too");
    let ways = ["period", "rate"].into_iter().filter_map(|key| Some((key, draft.without_option(gate, key)?)));
    Some(found.choose(("remove ", ""), ways).otherwise("remove one of the two"))
}

fn too_short(draft: &Draft<'_>, source: usize, sink: usize, period: Duration, deadline: Duration) -> Diagnostic {
    let (sender, receiver) = (draft.shared_path(source), draft.shared_path(sink));
    let [needed, promised] = [deadline, period].map(text);
    let key = promise_key(draft, source);
    let headline = format!("`{receiver}` needs a message every {needed}, and `{sender}` promises one every {promised}");
    let (longer, faster) = (text(period * 2), text(deadline / 2));
    let found = TOO_SHORT
        .at(headline, place(draft, sink, "deadline"), format!("at least one in {needed}"))
        .label(promise_place(draft, source), format!("one in {promised}"))
        .suggest(
            format!("write `deadline: {longer}` at `{receiver}`, which leaves room for a late message"),
            [draft.with_option(sink, "deadline", &longer)],
        );
    match key {
        "period" => found.suggest(
            format!("or have the sender send more often: write `period: {faster}` at `{sender}`"),
            [draft.with_option(source, "period", &faster)],
        ),
        _ => found.help("or have the sender send more often"),
    }
}

fn no_promise(draft: &Draft<'_>, sink: usize, senders: &[usize]) -> Diagnostic {
    let deadline = draft.gates[sink].options.deadline.map(text).unwrap_or_default();
    let headline = format!("nobody promises a message every {deadline} to `{}`", draft.shared_path(sink));
    let label = |source: &usize| match draft.gates[*source].options.share {
        true => "shares its messages among pullers".to_owned(),
        false => "does not say how often it sends".to_owned(),
    };
    let found = NO_PROMISE
        .at(headline, place(draft, sink, "deadline"), "")
        .labels(senders.iter().take(MOST_NAMED).map(|source| (draft.gates[*source].declaration(), label(source))));
    let found = match senders {
        [_] => found,
        _ => found.note(format!("senders: {}", listed(senders.iter().map(|source| draft.shared_path(*source))))),
    };
    let may_promise = senders.iter().any(|source| !draft.gates[*source].options.share);
    found.help(match may_promise {
        true => "write `rate` or `period` at the sender, for example `rate: 100Hz`",
        false => "remove `deadline`, or `share: true` at a sender with one puller",
    })
}

/// The place of a sender's promise.
pub(super) fn promise_place(draft: &Draft<'_>, source: usize) -> Span {
    place(draft, source, promise_key(draft, source))
}

/// The option with which a sender promises how often it sends.
fn promise_key(draft: &Draft<'_>, source: usize) -> &'static str {
    if draft.gates[source].option("rate").is_some() { "rate" } else { "period" }
}

/// The place of an option.
fn place(draft: &Draft<'_>, gate: usize, key: &str) -> Span {
    written(&draft.gates[gate], key).unwrap_or(draft.gates[gate].model.span)
}

/// The place of an option, if it is written.
pub(super) fn written(gate: &DraftGate<'_>, key: &str) -> Option<Span> {
    gate.option(key).map(|option| option.key.span.to(option.value.span))
}

#[cfg(test)]
mod tests {
    use super::{NO_PROMISE, TOO_SHORT, TWICE};
    use crate::check::testing::{advice_of_pairs, advice_with, rule_example};
    use expect_test::expect;

    #[test]
    fn deadline_is_shorter_than_the_period() {
        rule_example(
            &TOO_SHORT,
            expect![[r#"
            error: [SCL1801] `autopilot.rates` needs a message every 5ms, and `gyro.rates` promises one every 10ms
             --> topology.yaml:7:29
              |
            4 |       - rates: {pub: Rates, rate: 100Hz}
              |                             ----------- one in 10ms
            ...
            7 |       - rates: {sub: Rates, deadline: 5ms}
              |                             ^^^^^^^^^^^^^ at least one in 5ms
              |
              = help: write `deadline: 20ms` at `autopilot.rates`, which leaves room for a late message
              = help: or have the sender send more often
        "#]],
        );
    }

    #[test]
    fn sender_promises_nothing() {
        rule_example(
            &NO_PROMISE,
            expect![[r#"
            warning: [SCL1802] nobody promises a message every 20ms to `autopilot.rates`
             --> topology.yaml:7:29
              |
            4 |       - rates: {pub: Rates}
              |                 ---------- does not say how often it sends
            ...
            7 |       - rates: {sub: Rates, deadline: 20ms}
              |                             ^^^^^^^^^^^^^^
              |
              = help: write `rate` or `period` at the sender, for example `rate: 100Hz`
        "#]],
        );
    }

    #[test]
    fn rate_and_period_are_both_written() {
        rule_example(
            &TWICE,
            expect![[r#"
            error: [SCL1803] `gyro.rates` has both `rate` and `period`
             --> topology.yaml:4:42
              |
            4 |       - rates: {pub: Rates, rate: 100Hz, period: 20ms}
              |                             -----------  ^^^^^^^^^^^^
              |                             |
              |                             says how often, too
              |
              = help: remove `period` or `rate`
        "#]],
        );
    }

    #[test]
    fn the_components_of_a_kind_are_told_once() {
        let yaml = "\
kinds:
  - name: motor
    gates: [{state: {pub: T, rate: 1Hz}}, {noise: {pub: T}}]
  - name: eye
    gates: [{ticks: {sub: T, deadline: 6ms}}]
components:
  - {name: left_motor, kind: motor}
  - {name: right_motor, kind: motor}
  - {name: left_eye, kind: eye}
  - {name: right_eye, kind: eye}
  - {name: hub, gates: [{states: {sub: T, deadline: 5ms}}, {ticks: {pub: T, period: 1s}}, {noises: {sub: T, deadline: 7ms}}]}
connections:
  - [each motor.state, hub.states]
  - [hub.ticks, each eye.ticks]
  - [each motor.noise, hub.noises]
";
        let told = |yaml: &str| [&TOO_SHORT, &NO_PROMISE].map(|rule| advice_with(rule, yaml, &["T"])).concat();
        expect!["`each eye.ticks` needs a message every 6ms, and `hub.ticks` promises one every 1s [write `deadline: 2s` at `each eye.ticks`, which leaves room for a late message | or have the sender send more often: write `period: 3ms` at `hub.ticks`]; `hub.states` needs a message every 5ms, and `each motor.state` promises one every 1s [write `deadline: 2s` at `hub.states`, which leaves room for a late message | or have the sender send more often]"].assert_eq(&told(yaml));
        let silent = yaml.replace("period: 1s", "period: 1ms").replace("rate: 1Hz", "rate: 1kHz");
        expect!["nobody promises a message every 7ms to `hub.noises` [write `rate` or `period` at the sender, for example `rate: 100Hz`]"].assert_eq(&told(&silent));
    }

    #[test]
    fn promises_and_needs_in_many_shapes() {
        let file = |sender: &str, receiver: &str| {
            format!(
                "components:\n  - {{name: a, gates: [{{o: {{{sender}}}}}]}}\n  - {{name: b, gates: [{{i: \
                 {{{receiver}}}}}]}}\nconnections:\n  - [a.o, b.i]\n"
            )
        };
        let pairs = [
            ("pub: T, rate: 100Hz", "sub: T, deadline: 10ms"),
            ("pub: T, rate: 100Hz", "sub: T, deadline: 9999us"),
            ("pub: T, rate: 300Hz", "sub: T, deadline: 3ms"),
            ("pub: T, period: 1s", "sub: T, deadline: 500ms"),
            ("pub: T, rate: 0.5Hz", "sub: T, deadline: 1min"),
            ("push: T, period: 1s", "pull: T, deadline: 500ms"),
            ("push: T, period: 1s, share: true", "pull: T, deadline: 2s"),
            ("pub: T", "sub: T, deadline: 2s"),
            ("pub: T, period: 1s", "sub: T"),
        ];
        let told = advice_of_pairs(&[&TOO_SHORT, &NO_PROMISE], &pairs, file);
        expect![[r#"
            pub: T, rate: 100Hz -> sub: T, deadline: 10ms: 
            pub: T, rate: 100Hz -> sub: T, deadline: 9999us: `b.i` needs a message every 9999us, and `a.o` promises one every 10ms [write `deadline: 20ms` at `b.i`, which leaves room for a late message | or have the sender send more often]
            pub: T, rate: 300Hz -> sub: T, deadline: 3ms: `b.i` needs a message every 3ms, and `a.o` promises one every 3333us [write `deadline: 6666us` at `b.i`, which leaves room for a late message | or have the sender send more often]
            pub: T, period: 1s -> sub: T, deadline: 500ms: `b.i` needs a message every 500ms, and `a.o` promises one every 1s [write `deadline: 2s` at `b.i`, which leaves room for a late message | or have the sender send more often: write `period: 250ms` at `a.o`]
            pub: T, rate: 0.5Hz -> sub: T, deadline: 1min: 
            push: T, period: 1s -> pull: T, deadline: 500ms: `b.i` needs a message every 500ms, and `a.o` promises one every 1s [write `deadline: 2s` at `b.i`, which leaves room for a late message | or have the sender send more often: write `period: 250ms` at `a.o`]
            push: T, period: 1s, share: true -> pull: T, deadline: 2s: nobody promises a message every 2s to `b.i` [remove `deadline`, or `share: true` at a sender with one puller]
            pub: T -> sub: T, deadline: 2s: nobody promises a message every 2s to `b.i` [write `rate` or `period` at the sender, for example `rate: 100Hz`]
            pub: T, period: 1s -> sub: T: 
        "#]].assert_eq(&told);
    }
}
