//! The text of a deadlock: what waits where, what follows, and the ways out.

use super::search::Deadlock;
use crate::check::circles::{self, Step, place};
use crate::check::draft::Draft;
use crate::check::unconnected::type_text;
use crate::check::waits::Waiting;
use crate::diagnostic::{Diagnostic, Edit, Rule};
use crate::topology::{GateKind, WhenFull};
use scl_text::list::listed;
use std::collections::BTreeSet;

/// Maximum number of connections of one kind for which a change is suggested.
const MOST_WAYS: usize = 3;

/// Maximum number of senders of a queue that a suggestion changes.
const MOST_SENDERS: usize = 8;

/// The headline of every deadlock, before the names.
pub(super) const HEADLINE: &str = "components wait for each other";

pub(super) fn report(rule: &'static Rule, draft: &Draft<'_>, deadlock: &Deadlock, waiting: &Waiting) -> Diagnostic {
    let steps = &deadlock.steps;
    let headline = format!("{HEADLINE}: {}", names(draft, deadlock));
    let others = steps[1..].iter().map(|step| (place(draft, step), reason(draft, step)));
    let found = rule.at(headline, place(draft, &steps[0]), reason(draft, &steps[0])).labels(others);
    let mut found = ways_out(draft, found, steps, waiting).note(consequence(draft, steps));
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
pub(super) fn reason(draft: &Draft<'_>, step: &Step) -> String {
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

/// The connections that stand last in the circle come first: they rather lead back.
fn ways_out(draft: &Draft<'_>, mut found: Diagnostic, steps: &[Step], waiting: &Waiting) -> Diagnostic {
    let of_kind = |wanted| {
        let steps = steps.iter().rev().filter(move |step| kind(draft, step) == Some(wanted));
        steps.filter_map(|step| draft.links[step.link].flow).take(MOST_WAYS).collect::<Vec<_>>()
    };
    // Prefer dropping published messages: newer values usually replace them anyway, unlike pushed work.
    let mut queues = of_kind(GateKind::Pub);
    if queues.is_empty() {
        queues = of_kind(GateKind::Push);
    }
    let mut sinks: Vec<usize> = Vec::new();
    for &(_, sink) in &queues {
        if !sinks.contains(&sink) {
            let or = if sinks.is_empty() { "" } else { "or " };
            found = drop_messages(draft, found, or, sink, waiting);
            sinks.push(sink);
        }
    }
    let requests = of_kind(GateKind::Req);
    if let (Some(&(source, _)), false) = (requests.first(), queues.is_empty()) {
        let path = draft.path(source);
        found = found.help(format!("or say how long the request may wait before it fails: `timeout` at `{path}`"));
    }
    for (source, sink) in requests {
        let or = if found.helps.is_empty() { "" } else { "or " };
        let (asks, answers) = (draft.path(source), draft.component_name(sink));
        let help = format!(
            "{or}let `{answers}` publish what `{asks}` asks for, if that is the same for each request: `pub` and `sub` \
             instead of `rep` and `req`"
        );
        found = match published(draft, source, sink) {
            Some(edits) => found.suggest(help, edits),
            None => found.help(help),
        };
    }
    let code = found.code();
    found.help(format!(
        "or, if a component never waits at its connection while another one waits for it, write\n`# scl: allow({code}) \
         reason` above that connection"
    ))
}

/// The changes that make a request a published message of the type of its reply. `None` if others ask the same gate.
fn published(draft: &Draft<'_>, source: usize, sink: usize) -> Option<Vec<Edit>> {
    let reply = |gate| type_text(draft, gate).rsplit_once("->").map(|(_, reply)| reply.trim().to_owned());
    let with = |gate, kind| draft.with_kind(gate, kind, reply(gate).as_deref());
    let is_only = draft.gates[sink].uses == 1 && draft.gates[source].uses == 1;
    let changed = [with(sink, GateKind::Pub)?, with(source, GateKind::Sub)?].concat();
    is_only.then_some(changed)
}

/// Adds a help that says which options to change so that the queue of `sink` drops messages.
pub(in crate::check) fn drop_messages(
    draft: &Draft<'_>,
    found: Diagnostic,
    or: &str,
    sink: usize,
    waiting: &Waiting,
) -> Diagnostic {
    let drop = WhenFull::DropOldest.word();
    let way = format!("{or}let `{}` drop messages: `when_full: {drop}`", draft.path(sink));
    // A sender that waits for nothing else needs no `backpressure` any more.
    let senders = waiting.senders[sink].iter().take(MOST_SENDERS).filter(|sender| waiting.receivers[**sender] == 1);
    let (senders, removed): (Vec<usize>, Vec<Edit>) =
        senders.filter_map(|&sender| Some((sender, draft.without_option(sender, "backpressure")?))).unzip();
    let edits = std::iter::once(draft.with_option(sink, "when_full", drop)).chain(removed);
    match senders.as_slice() {
        [] => found.suggest(way, edits),
        senders => {
            let names = listed(senders.iter().map(|&sender| draft.path(sender)));
            found.suggest(format!("{way}, and remove `backpressure` from {names}"), edits)
        }
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
