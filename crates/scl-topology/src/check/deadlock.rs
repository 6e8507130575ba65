//! SCL0707: components that wait for each other. `docs/deadlocks.md` is about this rule.

mod report;
mod search;
#[cfg(test)]
mod tests;

pub(super) use report::drop_messages;

use super::circles::{Step, place};
use super::draft::Draft;
use super::feedback::PUSHES;
use super::waits::{self, Call, Wait, Waiting};
use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::source::Line;
use crate::topology::GateKind;
use report::{HEADLINE, is_request, kind, reason, report};
use std::collections::HashSet;

/// SCL0707.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0707",
    severity: Severity::Error,
    title: "components wait for each other",
    explanation: "Each component of a circle can wait for the next one: for the answer to a request, or, with \
                  `backpressure: true` and `when_full: wait`, for room in its queue. A waiting component neither \
                  answers nor receives, so once all of them wait, they stay blocked until a request times out, or \
                  forever. Let one queue of the circle drop messages, or publish what another component asks for. If a \
                  component never waits at a connection while another one waits for it, say so: `# scl: allow(SCL0707) \
                  reason` above that connection. docs/deadlocks.md shows each kind of circle and how to break it.",
    example: " components:
   - name: arbiter
     gates:
       - power: req
-      - mission: rep
+      - mission: pub
   - name: power
     gates:
       - status: rep
-      - mission: req
+      - mission: sub
 connections:
   - [arbiter.power, power.status]
   - [power.mission, arbiter.mission]
",
};

/// Reports deadlocks. `allowed_lines` returns the lines for which a comment allows a rule.
pub(super) fn check(draft: &Draft<'_>, allowed_lines: impl Fn(&Rule) -> HashSet<Line>, problems: &mut Diagnostics) {
    let waits: Vec<Wait> = waits::all(draft).into_iter().filter(|wait| !wait.is_for_itself()).collect();
    let allowed = Allowed { waiting: allowed_lines(&RULE), pushing: allowed_lines(&PUSHES) };
    let judged: Vec<Wait> = waits.iter().filter(|wait| !allowed.any(draft, wait)).cloned().collect();
    let components = draft.components.len();
    let mut found = search::find(components, &requests(&judged), |_| true);
    found.extend(search::find(components, &endless(&judged), |step| !is_request(draft, step)));
    let waiting = Waiting::of(draft);
    problems.extend(found.iter().map(|deadlock| report(&RULE, draft, deadlock, &waiting)));
    if judged.len() < waits.len() {
        // Also report what a comment allows: it is suppressed later, and a comment that suppresses nothing is reported.
        let knots = [requests(&waits), endless(&waits)].map(|waits| search::knots(components, &waits));
        let is_deadlocked = |step: &&Step| knots.iter().any(|knots| knots[step.from] == knots[step.to]);
        let steps = waits.iter().flat_map(|wait| &wait.steps).filter(is_deadlocked);
        problems.extend(steps.filter_map(|step| {
            allowed.rule(draft, step).map(|rule| rule.at(HEADLINE, place(draft, step), reason(draft, step)))
        }));
    }
}

/// Selects the requests: in a circle, a request that is sent while answering one is never answered, however long its
/// timeout.
fn requests(waits: &[Wait]) -> Vec<Wait> {
    waits.iter().filter(|wait| wait.call != Call::Send).cloned().collect()
}

/// Selects the waits without a declared timeout. A full queue is emptied once a request has failed, and a timeout in
/// the file shows that this is intended.
fn endless(waits: &[Wait]) -> Vec<Wait> {
    waits.iter().filter(|wait| wait.call != Call::Request { has_timeout: true }).cloned().collect()
}

/// The lines at which a comment allows waiting.
struct Allowed {
    waiting: HashSet<Line>,
    pushing: HashSet<Line>,
}

impl Allowed {
    /// Returns the rule that a comment allows for a step. A comment that allows a circle of push gates also allows it
    /// to wait.
    fn rule(&self, draft: &Draft<'_>, step: &Step) -> Option<&'static Rule> {
        let line = draft.sources.line(place(draft, step));
        if self.waiting.contains(&line) {
            return Some(&RULE);
        }
        (self.pushing.contains(&line) && kind(draft, step) == Some(GateKind::Push)).then_some(&PUSHES)
    }

    fn any(&self, draft: &Draft<'_>, wait: &Wait) -> bool {
        wait.steps.iter().any(|step| self.rule(draft, step).is_some())
    }
}
