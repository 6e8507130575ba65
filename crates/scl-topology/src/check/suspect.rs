//! The gates that an end may have meant: they count as connected, because a problem is reported for the end already.

use super::draft::Draft;
use crate::topology::GateKind;
use std::collections::HashSet;

/// Marks the gates that the ends without a gate may mean: those of a component and those of a name that such an end
/// contains. If an end contains neither, it may mean any gate that fits the other end.
pub(super) fn mark(draft: &mut Draft<'_>) {
    let mut words: HashSet<&str> = HashSet::new();
    let mut kinds: Vec<GateKind> = Vec::new();
    for link in &draft.links {
        for end in 0..2 {
            if link.ends[end].is_some() || link.model.ends[end].value.is_empty() {
                continue;
            }
            let other = link.ends[1 - end];
            let text = link.model.ends[end].value.as_str();
            let known = words_of(text).filter(|word| is_known(draft, word, other));
            words.extend(known.clone());
            if known.count() == 0 {
                let kind = other.and_then(|other| draft.gates[other].kind).map(GateKind::opposite);
                let fitting = GateKind::ALL.into_iter().filter(|fitting| kind.is_none_or(|kind| kind == *fitting));
                fitting.for_each(|fitting| {
                    if !kinds.contains(&fitting) {
                        kinds.push(fitting)
                    }
                });
            }
        }
    }
    let mut broken: Vec<GateKind> = Vec::new();
    for end in &draft.model.broken_ends {
        match draft.find(&end.value) {
            Some(gate) => broken.extend(draft.gates[gate].kind.filter(|kind| !broken.contains(kind))),
            None => words.extend(words_of(&end.value)),
        }
    }
    // What an end without another one was to be connected to is unknown.
    kinds.extend(broken.iter().map(|kind| kind.opposite()).filter(|kind| !broken.contains(kind)));
    for at in 0..draft.gates.len() {
        let gate = &draft.gates[at];
        let is_named = |name: &str| words.contains(name);
        let may_be_meant = is_named(&gate.model.name.value)
            || is_named(draft.component_name(at))
            || gate.kind.is_some_and(|kind| kinds.contains(&kind));
        draft.gates[at].named |= may_be_meant;
    }
}

fn words_of(text: &str) -> impl Iterator<Item = &str> + Clone {
    text.split(|letter: char| !(letter.is_alphanumeric() || matches!(letter, '_' | '-')))
        .filter(|word| !word.is_empty())
}

/// Whether a component or a gate other than that at the other end has this name.
fn is_known(draft: &Draft<'_>, word: &str, other: Option<usize>) -> bool {
    draft.component(word).is_some() || draft.gates_named(word).iter().take(2).any(|gate| Some(*gate) != other)
}
