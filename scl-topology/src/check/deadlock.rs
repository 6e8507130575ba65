//! SCL0707: components that wait for each other. `docs/deadlocks.md` is about this rule.

mod search;

use super::circles::{self, Step};
use super::draft::Draft;
use super::feedback::PUSHES;
use super::waits::{self, Call, Wait};
use crate::diagnostic::Severity;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::rule::{Examples, Rule};
use crate::source::Span;
use crate::topology::{GateKind, WhenFull};
use crate::wording::listed;
use search::Deadlock;
use std::collections::{BTreeSet, HashSet};

/// SCL0707.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0707",
    severity: Severity::Error,
    title: "components wait for each other",
    explanation: "Each component of a circle can wait for the next one: for the answer to a request, or, with \
                  `backpressure: true` and `when_full: wait`, for room in its queue. A component that waits answers \
                  nothing and receives nothing, so once all of them wait, nothing moves until a request fails, or ever. \
                  Let one queue of the circle drop messages, or publish what another component asks for. If a \
                  component never waits at a connection while another one waits for it, say so: `# scl: allow(SCL0707) \
                  reason` above that connection. docs/deadlocks.md shows every shape and its ways out.",
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

/// `allowed_lines` tells about which lines a comment allows a rule.
pub(super) fn check(draft: &Draft<'_>, allowed_lines: impl Fn(&Rule) -> HashSet<u32>, problems: &mut Diagnostics) {
    let waits: Vec<Wait> = waits::all(draft).into_iter().filter(|wait| !wait.is_for_itself()).collect();
    let allowed = Allowed { waiting: allowed_lines(&RULE), pushing: allowed_lines(&PUSHES) };
    let judged: Vec<Wait> = waits.iter().filter(|wait| !allowed.any(draft, wait)).cloned().collect();
    let components = draft.components.len();
    let mut found = search::find(components, &requests(&judged), |_| true);
    found.extend(search::find(components, &endless(&judged), |step| !is_request(draft, step)));
    let receivers = waits::receivers_that_wait(draft);
    problems.extend(found.iter().map(|deadlock| report(draft, deadlock, &receivers)));
    if judged.len() < waits.len() {
        // What a comment allows is found all the same: that tells whether the comment has an effect.
        let knots = [requests(&waits), endless(&waits)].map(|waits| search::knots(components, &waits));
        let is_deadlocked = |step: &&Step| knots.iter().any(|knots| knots[step.from] == knots[step.to]);
        let steps = waits.iter().flat_map(|wait| &wait.steps).filter(is_deadlocked);
        problems.extend(steps.filter_map(|step| {
            allowed.rule(draft, step).map(|rule| rule.at(HEADLINE, place(draft, step), waiting(draft, step)))
        }));
    }
}

/// A request that is sent while answering one is never answered, however long its timeout.
fn requests(waits: &[Wait]) -> Vec<Wait> {
    waits.iter().filter(|wait| wait.call != Call::Send).cloned().collect()
}

/// A full queue is emptied once a request has failed. Where the file says how long that takes, it is intended.
fn endless(waits: &[Wait]) -> Vec<Wait> {
    waits.iter().filter(|wait| wait.call != Call::Request { has_timeout: true }).cloned().collect()
}

/// The connections at which a comment allows to wait.
struct Allowed {
    waiting: HashSet<u32>,
    pushing: HashSet<u32>,
}

impl Allowed {
    /// The rule that is allowed. A comment that allows a circle of push gates allows it to wait, too.
    fn rule(&self, draft: &Draft<'_>, step: &Step) -> Option<&'static Rule> {
        let span = place(draft, step);
        let line = draft.sources.file(span.file).line(span.start);
        if self.waiting.contains(&line) {
            return Some(&RULE);
        }
        (self.pushing.contains(&line) && kind(draft, step) == Some(GateKind::Push)).then_some(&PUSHES)
    }

    fn any(&self, draft: &Draft<'_>, wait: &Wait) -> bool {
        wait.steps.iter().any(|step| self.rule(draft, step).is_some())
    }
}

const HEADLINE: &str = "components wait for each other";

fn report(draft: &Draft<'_>, deadlock: &Deadlock, receivers: &[usize]) -> Diagnostic {
    let steps = &deadlock.steps;
    let headline = format!("{HEADLINE}: {}", names(draft, deadlock));
    let mut found = RULE.at(headline, place(draft, &steps[0]), waiting(draft, &steps[0]));
    for step in &steps[1..] {
        found = found.label(place(draft, step), waiting(draft, step));
    }
    found = ways_out(draft, found, steps, receivers).note(consequence(draft, steps));
    if !deadlock.is_circle {
        found =
            found.note("a `push` gate that shares its work waits only while the queues of all its pullers are full");
    }
    if deadlock.has_others {
        found = found.note("more circles run through these components, and are shown when these are broken");
    }
    found
}

/// `` `a` -> `b` -> `a` `` of a circle, `` `a`, `b`, `c` `` of a knot.
fn names(draft: &Draft<'_>, deadlock: &Deadlock) -> String {
    if deadlock.is_circle {
        return circles::round(draft, &deadlock.steps);
    }
    let members: BTreeSet<usize> = deadlock.steps.iter().map(|step| step.from).collect();
    listed(members.iter().map(|&component| name(draft, component)))
}

/// What one connection does to its sender.
fn waiting(draft: &Draft<'_>, step: &Step) -> String {
    let from = name(draft, step.from);
    match draft.links[step.link].flow {
        Some((source, _)) if draft.gates[source].kind == Some(GateKind::Req) => {
            let timeout = draft.gates[source].options.timeout;
            format!("`{from}` waits until `{}` answers, at most {timeout:?}", name(draft, step.to))
        }
        Some((_, sink)) => format!("`{from}` waits while the queue of `{}` is full", draft.path(sink)),
        None => String::new(),
    }
}

fn ways_out(draft: &Draft<'_>, mut found: Diagnostic, steps: &[Step], receivers: &[usize]) -> Diagnostic {
    let first = |wanted| {
        let step = steps.iter().find(|step| kind(draft, step) == Some(wanted));
        step.and_then(|step| draft.links[step.link].flow)
    };
    // What is published is mostly replaced by newer values anyway; work is not.
    let queue = first(GateKind::Pub).or_else(|| first(GateKind::Push));
    if let Some((source, sink)) = queue {
        found = drop_messages(draft, found, source, sink, receivers[source]);
    }
    if let Some((source, sink)) = first(GateKind::Req) {
        let (asks, answers) = (draft.component_name(source), draft.component_name(sink));
        if queue.is_some() {
            let path = draft.path(source);
            found = found.help(format!("or say how long the request may wait before it fails: `timeout` at `{path}`"));
        }
        let kinds = "`pub` and `sub` instead of `rep` and `req`";
        let or = if queue.is_some() { "or " } else { "" };
        found = found.help(format!("{or}let `{answers}` publish what `{asks}` asks for: {kinds}"));
    }
    found.help(format!(
        "or, if a component never waits at its connection while another one waits for it, write\n`# scl: allow({}) \
         reason` above that connection",
        RULE.code
    ))
}

/// Says which option to change where, so that a queue drops messages. `receivers` make the gate `source` wait.
pub(super) fn drop_messages(
    draft: &Draft<'_>,
    found: Diagnostic,
    source: usize,
    sink: usize,
    receivers: usize,
) -> Diagnostic {
    let drop = WhenFull::DropOldest.word();
    let found = match draft.gates[sink].option("when_full") {
        Some(option) => found.maybe_fix(option.value.span, drop),
        None => found,
    };
    let way = format!("let `{}` drop messages: `when_full: {drop}`", draft.path(sink));
    match receivers {
        0 | 1 => found.help(format!("{way}, and remove `backpressure` from `{}`", draft.path(source))),
        _ => found.help(way),
    }
}

fn consequence(draft: &Draft<'_>, steps: &[Step]) -> String {
    let requests = steps.iter().filter(|step| is_request(draft, step));
    let sources = requests.filter_map(|step| draft.links[step.link].flow).map(|(source, _)| &draft.gates[source]);
    match sources.clone().map(|gate| gate.options.timeout).min() {
        Some(_) if sources.count() == steps.len() => {
            "a request sent while answering one of the same circle is never answered, however long its timeout"
                .to_owned()
        }
        Some(timeout) => format!("once all of them wait, nothing moves until a request fails after {timeout:?}"),
        None => "once all of them wait, nothing moves any more".to_owned(),
    }
}

fn kind(draft: &Draft<'_>, step: &Step) -> Option<GateKind> {
    draft.links[step.link].flow.and_then(|(source, _)| draft.gates[source].kind)
}

fn is_request(draft: &Draft<'_>, step: &Step) -> bool {
    kind(draft, step) == Some(GateKind::Req)
}

fn name<'m>(draft: &Draft<'m>, component: usize) -> &'m str {
    &draft.components[component].model.name.value
}

fn place(draft: &Draft<'_>, step: &Step) -> Span {
    draft.links[step.link].model.span
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{codes, example, problems, rule_example};
    use expect_test::expect;

    /// Components `name | gates`, then connections.
    fn file(components: &[(&str, &str)], connections: &str) -> String {
        let gates = |gates: &str| gates.split("; ").map(|gate| format!("      - {gate}\n")).collect::<String>();
        let component = |(name, list): &(&str, &str)| format!("  - name: {name}\n    gates:\n{}", gates(list));
        let components: String = components.iter().map(component).collect();
        let connections: String = connections.split("; ").map(|ends| format!("  - [{ends}]\n")).collect();
        format!("components:\n{components}connections:\n{connections}")
    }

    fn publishers() -> String {
        let gates =
            |name| format!("{name}_out: {{pub: T, backpressure: true}}; {name}_in: {{sub: T, when_full: wait}}");
        file(&[("a", &gates("a")), ("b", &gates("b"))], "a.a_out, b.b_in; b.b_out, a.a_in")
    }

    fn answered_with_a_push() -> String {
        let a = "ask: {req: A -> B}; results: {pull: T, when_full: wait}";
        let b = "answer: {rep: A -> B}; work: {push: T, backpressure: true}";
        file(&[("a", a), ("b", b)], "a.ask, b.answer; b.work, a.results")
    }

    fn shared_work() -> String {
        let gates =
            |name| format!("{name}_out: {{push: T, backpressure: true}}; {name}_in: {{pull: T, when_full: wait}}");
        let a = "work: {push: T, backpressure: true, share: true}; results: {pull: T, when_full: wait}";
        let connections = "a.work, b.b_in; a.work, c.c_in; b.b_out, a.results; c.c_out, a.results";
        file(&[("a", a), ("b", &gates("b")), ("c", &gates("c"))], connections)
    }

    #[test]
    fn components_wait_for_each_other() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0707] components wait for each other: `arbiter` -> `power` -> `arbiter`
              --> topology.yaml:11:5
               |
            11 |   - [arbiter.power, power.status]
               |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ `arbiter` waits until `power` answers, at most 1s
            12 |   - [power.mission, arbiter.mission]
               |     -------------------------------- `power` waits until `arbiter` answers, at most 1s
               |
               = help: let `power` publish what `arbiter` asks for: `pub` and `sub` instead of `rep` and `req`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: a request sent while answering one of the same circle is never answered, however long its timeout
        "#]],
        );
    }

    #[test]
    fn full_queues() {
        example(
            "SCL0707",
            &publishers(),
            expect![[r#"
            error: [SCL0707] components wait for each other: `a` -> `b` -> `a`
              --> topology.yaml:11:5
               |
            11 |   - [a.a_out, b.b_in]
               |     ^^^^^^^^^^^^^^^^^ `a` waits while the queue of `b.b_in` is full
            12 |   - [b.b_out, a.a_in]
               |     ----------------- `b` waits while the queue of `a.a_in` is full
               |
               = help: let `b.b_in` drop messages: `when_full: drop_oldest`, and remove `backpressure` from `a.a_out`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: once all of them wait, nothing moves any more
        "#]],
        );
    }

    #[test]
    fn a_request_that_is_answered_with_a_push() {
        example(
            "SCL0707",
            &answered_with_a_push(),
            expect![[r#"
            error: [SCL0707] components wait for each other: `a` -> `b` -> `a`
              --> topology.yaml:11:5
               |
            11 |   - [a.ask, b.answer]
               |     ^^^^^^^^^^^^^^^^^ `a` waits until `b` answers, at most 1s
            12 |   - [b.work, a.results]
               |     ------------------- `b` waits while the queue of `a.results` is full
               |
               = help: let `a.results` drop messages: `when_full: drop_oldest`, and remove `backpressure` from `b.work`
               = help: or say how long the request may wait before it fails: `timeout` at `a.ask`
               = help: or let `b` publish what `a` asks for: `pub` and `sub` instead of `rep` and `req`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: once all of them wait, nothing moves until a request fails after 1s
        "#]],
        );
    }

    #[test]
    fn work_that_is_shared() {
        example(
            "SCL0707",
            &shared_work(),
            expect![[r#"
            error: [SCL0707] components wait for each other: `a`, `b`, `c`
              --> topology.yaml:15:5
               |
            15 |   - [a.work, b.b_in]
               |     ^^^^^^^^^^^^^^^^ `a` waits while the queue of `b.b_in` is full
            16 |   - [a.work, c.c_in]
               |     ---------------- `a` waits while the queue of `c.c_in` is full
            17 |   - [b.b_out, a.results]
               |     -------------------- `b` waits while the queue of `a.results` is full
            18 |   - [c.c_out, a.results]
               |     -------------------- `c` waits while the queue of `a.results` is full
               |
               = help: let `b.b_in` drop messages: `when_full: drop_oldest`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: once all of them wait, nothing moves any more
               = note: a `push` gate that shares its work waits only while the queues of all its pullers are full
        "#]],
        );
    }

    #[test]
    fn two_circles_with_a_common_connection() {
        let gates = "o: req; p: req; i: rep";
        let connections = "a.o, b.i; b.o, a.i; b.p, c.i; c.o, a.i";
        example(
            "SCL0707",
            &file(&[("a", gates), ("b", gates), ("c", "o: req; i: rep")], connections),
            expect![[r#"
            error: [SCL0707] components wait for each other: `a` -> `b` -> `a`
              --> topology.yaml:17:5
               |
            17 |   - [a.o, b.i]
               |     ^^^^^^^^^^ `a` waits until `b` answers, at most 1s
            18 |   - [b.o, a.i]
               |     ---------- `b` waits until `a` answers, at most 1s
               |
               = help: let `b` publish what `a` asks for: `pub` and `sub` instead of `rep` and `req`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: a request sent while answering one of the same circle is never answered, however long its timeout

            error: [SCL0707] components wait for each other: `a` -> `b` -> `c` -> `a`
              --> topology.yaml:17:5
               |
            17 |   - [a.o, b.i]
               |     ^^^^^^^^^^ `a` waits until `b` answers, at most 1s
            18 |   - [b.o, a.i]
            19 |   - [b.p, c.i]
               |     ---------- `b` waits until `c` answers, at most 1s
            20 |   - [c.o, a.i]
               |     ---------- `c` waits until `a` answers, at most 1s
               |
               = help: let `b` publish what `a` asks for: `pub` and `sub` instead of `rep` and `req`
               = help: or, if a component never waits at its connection while another one waits for it, write
                       `# scl: allow(SCL0707) reason` above that connection
               = note: a request sent while answering one of the same circle is never answered, however long its timeout
        "#]],
        );
    }

    #[test]
    fn a_circle_of_many() {
        let names: Vec<String> = (0..20).map(|at| format!("c{at}")).collect();
        let components: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), "o: req; i: rep")).collect();
        let pairs: Vec<String> = (0..20).map(|at| format!("c{at}.o, c{}.i", (at + 1) % 20)).collect();
        let (found, _) = problems(&file(&components, &pairs.join("; ")), None);
        let found: Vec<_> = found.iter().filter(|found| found.rule == &RULE).collect();
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].secondary.len(), found[0].unlisted), (16, 3));
        expect!["components wait for each other: `c0` -> `c1` -> `c2` -> `c3` -> `c4` -> `c5` -> `c6` -> `c7` -> 12 more -> `c0`"].assert_eq(&found[0].message);
    }

    /// Does what the first help says: changes `when_full`, and takes `backpressure` from the gate it names.
    fn with_the_way_out(yaml: &str) -> Option<String> {
        let (found, _) = problems(yaml, None);
        let found = found.into_iter().find(|found| found.rule == &RULE)?;
        let fix = &found.fixes[0];
        let mut out = yaml.to_owned();
        out.replace_range(fix.span.start as usize..fix.span.end as usize, &fix.replacement);
        if let Some((_, gate)) = found.helps[0].split_once("remove `backpressure` from `") {
            let gate = format!("- {}:", gate.split(['.', '`']).nth(1).unwrap());
            let line = out.lines().find(|line| line.contains(&gate)).unwrap().to_owned();
            out = out.replace(&line, &line.replace(", backpressure: true", ""));
        }
        Some(out)
    }

    #[test]
    fn the_way_out_makes_a_file_clean() {
        let hub = |name| format!("{name}_out: {{pub: T, backpressure: true}}; {name}_in: {{sub: T, when_full: wait}}");
        let star = file(
            &[("a", &hub("a")), ("b", &hub("b")), ("c", &hub("c"))],
            "a.a_out, b.b_in; a.a_out, c.c_in; b.b_out, a.a_in; c.c_out, a.a_in",
        );
        for mut yaml in [publishers(), answered_with_a_push(), shared_work(), star] {
            assert!(codes(&yaml).contains(&"SCL0707"), "{yaml}");
            let mut steps = 0;
            while let Some(better) = with_the_way_out(&yaml) {
                (yaml, steps) = (better, steps + 1);
                assert!(steps <= 3, "{yaml}");
            }
            assert_eq!(codes(&yaml), [""; 0], "{yaml}");
        }
    }
}
