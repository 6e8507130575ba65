//! SCL0707: components that wait for each other. `docs/deadlocks.md` is about this rule.

mod search;

use super::circles::{self, Step};
use super::control::allowed_lines;
use super::draft::Draft;
use super::feedback::PUSHES;
use super::waits::{self, Call, Wait};
use crate::catalogue::{Examples, Rule};
use crate::diagnostic::Severity;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::source::Span;
use crate::topology::GateKind;
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

/// A problem shows no more connections.
const MOST: usize = 8;

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let waits: Vec<Wait> = waits::all(draft).into_iter().filter(|wait| !wait.is_for_itself()).collect();
    let allowed = Allowed::of(draft);
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
    fn of(draft: &Draft<'_>) -> Self {
        let [waiting, pushing] = [&RULE, &PUSHES].map(|rule| allowed_lines(draft.model, rule.code));
        Self { waiting, pushing }
    }

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
    for step in steps[1..].iter().take(MOST - 1) {
        found = found.label(place(draft, step), waiting(draft, step));
    }
    for help in ways_out(draft, steps, receivers) {
        found = found.help(help);
    }
    found = found.note(consequence(draft, steps));
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

fn ways_out(draft: &Draft<'_>, steps: &[Step], receivers: &[usize]) -> Vec<String> {
    let first = |wanted| {
        let step = steps.iter().find(|step| kind(draft, step) == Some(wanted));
        step.and_then(|step| draft.links[step.link].flow)
    };
    let mut ways = Vec::new();
    // What is published is mostly replaced by newer values anyway; work is not.
    let queue = first(GateKind::Pub).or_else(|| first(GateKind::Push));
    if let Some((source, sink)) = queue {
        ways.push(drop_messages(draft, source, sink, receivers[source]));
    }
    if let Some((source, sink)) = first(GateKind::Req) {
        let (asks, answers) = (draft.component_name(source), draft.component_name(sink));
        if queue.is_some() {
            ways.push(format!(
                "or say how long the request may wait before it fails: `timeout` at `{}`",
                draft.path(source)
            ));
        }
        let kinds = "`pub` and `sub` instead of `rep` and `req`";
        ways.push(format!("let `{answers}` publish what `{asks}` asks for: {kinds}"));
    }
    ways.push(format!(
        "if a component never waits at its connection while another one waits for it, write\n`# scl: allow({}) reason` \
         above that connection",
        RULE.code
    ));
    ways
}

/// Which option to change where, so that a queue drops messages. `receivers` make the gate `source` wait.
pub(super) fn drop_messages(draft: &Draft<'_>, source: usize, sink: usize, receivers: usize) -> String {
    let drop = format!("let `{}` drop messages: `when_full: drop_oldest`", draft.path(sink));
    match receivers {
        0 | 1 => format!("{drop}, and remove `backpressure` from `{}`", draft.path(source)),
        _ => drop,
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
    use crate::check::testing::rule_example;
    use expect_test::expect;

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
                   = help: if a component never waits at its connection while another one waits for it, write
                           `# scl: allow(SCL0707) reason` above that connection
                   = note: a request sent while answering one of the same circle is never answered, however long its timeout
            "#]],
        );
    }
}
