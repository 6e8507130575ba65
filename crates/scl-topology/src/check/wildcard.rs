//! Ends with a wildcard, `*.telemetry`: a connection for each gate that it matches.

use super::draft::Draft;
use super::end::End;
use crate::diagnostic::{Diagnostic, Edit, separator};
use scl_text::list::listed;

/// Maximum number of connections that a proposal writes.
const MOST: usize = 30;

const HELP: &str = "write a connection for each gate, without `*`";

/// Proposes the connections that an end with a wildcard means, and marks their gates as connected.
pub(super) fn written_out(draft: &mut Draft<'_>, found: Diagnostic, [link, end]: End) -> Diagnostic {
    let pairs = pairs(draft, [link, end]);
    let connections: Vec<String> =
        pairs.iter().map(|[a, b]| format!("[{}, {}]", draft.path(*a), draft.path(*b))).collect();
    pairs.into_iter().flatten().for_each(|gate| draft.gates[gate].named = true);
    let place = draft.links[link].model.span;
    match separator(draft.sources.file(place.file), place).filter(|_| (1..=MOST).contains(&connections.len())) {
        Some(separator) => {
            let help = format!("write a connection for each gate: {}", listed(&connections));
            found.suggest(help, [Edit::new(place, connections.join(&separator))])
        }
        None => found.about("wildcard"),
    }
    .otherwise(HELP)
}

/// The pairs of gates that a connection with wildcards means: those that match and fit, of two components. If both ends
/// have one, those of one name.
fn pairs(draft: &mut Draft<'_>, [link, end]: End) -> Vec<[usize; 2]> {
    let other = draft.links[link].ends[1 - end];
    let texts = draft.links[link].model.ends.each_ref().map(|end| end.value.as_str());
    if !draft.may_search() || other.is_none() && !texts[1 - end].contains('*') {
        return Vec::new();
    }
    let matching = (0..draft.gates.len()).filter(|gate| is_match(draft, texts[end], *gate));
    let peers = |gate: usize| match other {
        Some(other) => vec![other],
        None => {
            let namesakes = draft.gates_named(&draft.gates[gate].model.name.value).iter().copied().take(MOST);
            namesakes.filter(|other| is_match(draft, texts[1 - end], *other)).collect()
        }
    };
    let pairs = matching.flat_map(|gate| peers(gate).into_iter().map(move |other| [gate, other]));
    let fits = |[a, b]: &[usize; 2]| {
        let are_declared = !draft.gates[*a].duplicate && !draft.gates[*b].duplicate;
        are_declared && draft.component_name(*a) != draft.component_name(*b) && draft.may_connect(*a, *b)
    };
    let mut pairs: Vec<[usize; 2]> = pairs.filter(fits).take(MOST + 1).collect();
    if end == 1 {
        pairs.iter_mut().for_each(|pair| pair.reverse());
    }
    pairs
}

/// Whether the path of a gate matches `component.gate` or `component/gate` with wildcards.
fn is_match(draft: &Draft<'_>, pattern: &str, gate: usize) -> bool {
    let pattern = pattern.trim_start_matches('/');
    let Some((component, name)) = pattern.split_once(['.', '/']) else { return false };
    matches(component, draft.component_name(gate)) && matches(name, &draft.gates[gate].model.name.value)
}

/// Whether a name has the parts of a pattern around its wildcards, in their order.
fn matches(pattern: &str, name: &str) -> bool {
    let Some((first, rest)) = pattern.split_once('*') else { return pattern == name };
    let (middle, last) = rest.rsplit_once('*').unwrap_or(("", rest));
    let Some(name) = name.strip_prefix(first).and_then(|name| name.strip_suffix(last)) else { return false };
    let mut left = name;
    middle.split('*').all(|part| match left.split_once(part) {
        _ if part.is_empty() => true,
        Some((_, behind)) => {
            left = behind;
            true
        }
        None => false,
    })
}
