//! Two gates of one name in a component: one was left over, or they are the two directions of one message.

use super::draft::Draft;
use super::merge::is_alike;
use crate::diagnostic::{Diagnostic, Edit, removal};
use crate::model::GateModel;
use crate::topology::GateKind;
use scl_text::list::all_of;

pub(super) fn with_ways(draft: &Draft<'_>, found: Diagnostic, [one, two]: [usize; 2]) -> Diagnostic {
    let [first, second] = [one, two].map(|gate| draft.gates[gate].model);
    if is_alike(first, second) {
        return with_removals(draft, found, [first, second]);
    }
    match [first, second].map(|gate| GateKind::of(&gate.kind.value)) {
        [Some(a), Some(b)] if a.is_source() != b.is_source() => {
            renamed(draft, found, [one, two], if a.is_source() { two } else { one })
        }
        _ => found,
    }
}

/// Gates of one kind and type: either of them may be meant, unless their options are the same.
fn with_removals(draft: &Draft<'_>, found: Diagnostic, gates: [&GateModel; 2]) -> Diagnostic {
    let options = gates.map(options);
    let removed = gates.map(|gate| removal(draft.sources.file(gate.span.file), gate.span));
    let is_one = options[0] == options[1] && gates[0].payload.is_some() == gates[1].payload.is_some();
    let is_read = gates.iter().all(|gate| !gate.options_unread);
    let [Some(first), Some(second)] = removed else { return found };
    if is_one && is_read {
        return found.propose("remove one of the two", [second]);
    }
    let own = |at: usize| {
        let own: Vec<&str> =
            options[at].iter().filter(|own| !options[1 - at].contains(own)).map(String::as_str).collect();
        if own.is_empty() { String::new() } else { format!(", which has {}", all_of(&own)) }
    };
    found
        .suggest(format!("remove the first one{}", own(0)), [first])
        .suggest(format!("remove the second one{}", own(1)), [second])
        .help("or give one of them another name")
}

/// The options of a gate as written.
fn options(gate: &GateModel) -> Vec<String> {
    let mut options: Vec<String> =
        gate.options.iter().map(|option| format!("{}: {}", option.key.value, option.value.value)).collect();
    options.sort_unstable();
    options
}

/// Suggests a name of its own for the receiving one of two gates. Of a connection between two such pairs of gates, the
/// second end receives.
fn renamed(draft: &Draft<'_>, found: Diagnostic, gates: [usize; 2], receiver: usize) -> Diagnostic {
    let (owner, model) = (draft.component_name(receiver), draft.gates[receiver].model);
    let (name, word) = (&model.name.value, &model.kind.value);
    let other = format!("{name}_in");
    if draft.gate(owner, &other).is_some() {
        return found;
    }
    let mut edits = vec![Edit::new(model.name.span, draft.sources.quoted_as(model.name.span, &other))];
    for link in &draft.links {
        for end in 0..2 {
            let peer = link.ends[1 - end].and_then(|peer| draft.gates[peer].kind);
            let receives = peer.map_or(end == 1, GateKind::is_source);
            if receives && link.ends[end].is_some_and(|gate| gates.contains(&gate)) {
                let place = link.model.ends[end].span;
                edits.push(Edit::new(place, draft.sources.quoted_as(place, &format!("{owner}.{other}"))));
            }
        }
    }
    let connections = if edits.len() > 1 { ", also in its connections" } else { "" };
    found.suggest(format!("give the `{word}` gate a name of its own, for example `{other}`{connections}"), edits)
}
