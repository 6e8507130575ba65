//! Components of one name that the connections tell apart by a word before it: `left.camera.images`, as with the
//! namespaces of other tools.

use super::draft::Draft;
use super::end::{End, Fault};
use super::named::Noun;
use crate::diagnostic::Edit;
use scl_text::list::all_of;

/// Maximum number of ends that are searched.
const SEARCHED: usize = 64;

/// Takes the ends that name a repeated component in this way. Returns names for all its declarations, in the order in
/// which the connections use them, with the changes. `None` unless there are as many words as declarations.
pub(super) fn prefixed(
    draft: &Draft<'_>,
    component: &str,
    faults: &mut [(Fault<'_>, Vec<End>)],
) -> Option<(String, Vec<Edit>)> {
    let (_, ends) = faults.iter_mut().find(|(fault, _)| *fault == Fault::Shape)?;
    let parts = |[link, end]: End| {
        let text = draft.links[link].model.ends[end].value.as_str();
        let words: Vec<&str> = text.trim_start_matches('/').split(['.', '/']).collect();
        match words.as_slice() {
            [prefix, name, gate] if *name == component && draft.gate(name, gate).is_some() => Some([*prefix, *gate]),
            _ => None,
        }
    };
    let mut names: Vec<String> = Vec::new();
    let mut edits: Vec<Edit> = Vec::new();
    for &end_of in ends.iter().take(SEARCHED) {
        let Some([prefix, gate]) = parts(end_of) else { continue };
        let name = format!("{prefix}.{component}");
        let place = draft.links[end_of[0]].model.ends[end_of[1]].span;
        let end = format!("{name}.{gate}");
        if draft.links[end_of[0]].model.ends[end_of[1]].value != end {
            edits.push(Edit::new(place, draft.sources.quoted_as(place, &end)));
        }
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let declared: Vec<_> = draft.declarations(component).take(names.len() + 1).collect();
    if names.len() != declared.len() || !names.iter().all(|name| Noun::Component.is_well_formed(name)) {
        return None;
    }
    let renamed = declared.iter().zip(&names).map(|(component, name)| {
        let place = component.name.span;
        Edit::new(place, draft.sources.quoted_as(place, name))
    });
    edits.extend(renamed);
    ends.retain(|end| parts(*end).is_none());
    Some((format!("name them {}, as the connections do", all_of(&names)), edits))
}
