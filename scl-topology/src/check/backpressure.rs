//! SCL0410: a receiver that would make its sender wait, and a sender that never waits.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::topology::{GateKind, WhenFull};

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    for (link, source, sink) in draft.flows() {
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
    let headline =
        format!("`{}` would make `{}` wait, which it does not allow", draft.path(sink), draft.path(source));
    let gate = draft.gates[source].model;
    let mut found = Diagnostic::error("SCL0410", headline, draft.links[link].model.span, "")
        .label(draft.gates[source].declaration(), format!("never waits for a {receiver}"));
    if let Some(option) = draft.gates[sink].option("when_full") {
        found = found.label(option.key.span.to(option.value.span), format!("makes the {sender} wait"));
    }
    let kind = &gate.kind.value;
    let message = super::unconnected::type_text(draft, source);
    let name = &gate.name.value;
    found
        .help(format!("allow it on the {sender}: `{name}: {{{kind}: {message}, backpressure: true}}`"))
        .help(format!("or let the {receiver} lose messages: `when_full: drop_oldest`"))
}
