//! The gates that a file exports in case that it becomes a group: they count as connected. SCL1605.

use super::draft::Draft;
use crate::diagnostic::{Diagnostics, Edit};
use crate::groups::UNKNOWN_EXPORT;
use crate::suggest::similar;
use scl_text::gate_name::split;

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    for export in &draft.model.exports {
        let gate = &export.gate;
        if let Some(found) = draft.find(&gate.value) {
            draft.gates[found].named = true;
            continue;
        }
        if draft.model.components_unread || !draft.may_search() {
            continue;
        }
        let found = UNKNOWN_EXPORT.at(format!("no component has the gate `{}`", gate.value), gate.span, "");
        let near = match split(&gate.value) {
            Some((owner, name)) if draft.component(owner).is_some() => {
                if draft.declarations(owner).any(|component| component.gates_unread) {
                    continue;
                }
                let gates = draft.gates_of(owner).map(|at| draft.gates[at].model.name.value.as_str());
                similar(name, gates).iter().map(|name| format!("{owner}.{name}")).collect()
            }
            Some((owner, name)) => {
                let names = similar(owner, draft.component_names.iter().copied());
                let has = |owner: &&&str| draft.gate(owner, name).is_some();
                names.iter().filter(has).map(|owner| format!("{owner}.{name}")).collect()
            }
            None => draft.gates_named(&gate.value).iter().take(3).map(|at| draft.path(*at)).collect::<Vec<_>>(),
        };
        // What is meant is connected.
        for at in near.iter().filter_map(|path| draft.find(path)).collect::<Vec<_>>() {
            draft.gates[at].named = true;
        }
        let edit = |path: &String| Edit::new(gate.span, draft.sources.quoted_as(gate.span, path));
        let found = found.choose(("write ", ""), near.iter().map(|path| (path.as_str(), edit(path))));
        problems.push(found.otherwise("an export is written `name: component.gate`"));
    }
}
