//! The text of a deadlock: what waits where, what follows, and the ways out.

use super::search::Deadlock;
use crate::check::circles::{self, Step, place};
use crate::check::draft::Draft;
use crate::diagnostic::{Diagnostic, Rule};
use crate::topology::{GateKind, WhenFull};
use scl_text::list::listed;
use std::collections::BTreeSet;

/// The headline of every deadlock, before the names.
pub(super) const HEADLINE: &str = "components wait for each other";

pub(super) fn report(rule: &'static Rule, draft: &Draft<'_>, deadlock: &Deadlock, receivers: &[usize]) -> Diagnostic {
    let steps = &deadlock.steps;
    let headline = format!("{HEADLINE}: {}", names(draft, deadlock));
    let others = steps[1..].iter().map(|step| (place(draft, step), waiting(draft, step)));
    let found = rule.at(headline, place(draft, &steps[0]), waiting(draft, &steps[0])).labels(others);
    let mut found = ways_out(draft, found, steps, receivers).note(consequence(draft, steps));
    if !deadlock.is_circle {
        found =
            found.note("a `push` gate that shares its work waits only while the queues of all its pullers are full");
    }
    if deadlock.has_others {
        found = found.note("more circles run through these components; they are shown once these are broken");
    }
    found
}

/// `` `a` -> `b` -> `a` `` for a circle, `` `a`, `b`, `c` `` for a knot.
fn names(draft: &Draft<'_>, deadlock: &Deadlock) -> String {
    if deadlock.is_circle {
        return circles::round(draft, &deadlock.steps);
    }
    let members: BTreeSet<usize> = deadlock.steps.iter().map(|step| step.from).collect();
    listed(members.iter().map(|&component| name(draft, component)))
}

/// Says how one connection makes its sender wait.
pub(super) fn waiting(draft: &Draft<'_>, step: &Step) -> String {
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
    // Prefer dropping published messages: newer values usually replace them anyway, unlike pushed work.
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
    let code = found.code();
    found.help(format!(
        "or, if a component never waits at its connection while another one waits for it, write\n`# scl: allow({code}) \
         reason` above that connection"
    ))
}

/// Adds a help that says which option to change so that the queue of `sink` drops messages. `receivers` is the number
/// of receivers that make the gate `source` wait.
pub(in crate::check) fn drop_messages(
    draft: &Draft<'_>,
    found: Diagnostic,
    source: usize,
    sink: usize,
    receivers: usize,
) -> Diagnostic {
    let drop = WhenFull::DropOldest.word();
    let way = format!("let `{}` drop messages: `when_full: {drop}`", draft.path(sink));
    let edit = draft.with_option(sink, "when_full", drop);
    match draft.without_option(source, "backpressure") {
        Some(removed) if receivers <= 1 => {
            found.suggest(format!("{way}, and remove `backpressure` from `{}`", draft.path(source)), [edit, removed])
        }
        _ => found.suggest(way, [edit]),
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

pub(super) fn kind(draft: &Draft<'_>, step: &Step) -> Option<GateKind> {
    draft.links[step.link].flow.and_then(|(source, _)| draft.gates[source].kind)
}

pub(super) fn is_request(draft: &Draft<'_>, step: &Step) -> bool {
    kind(draft, step) == Some(GateKind::Req)
}

fn name<'m>(draft: &Draft<'m>, component: usize) -> &'m str {
    &draft.components[component].model.name.value
}
