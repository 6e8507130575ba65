//! `except` in a file that becomes several groups: each group has the entry, which names its own component. If all of
//! these components are excepted, their kind is.

use crate::model::{ComponentModel, Model};
use crate::source::Span;
use std::collections::{HashMap, HashSet};

/// Names the kind in the place of its components, if an entry of `everyone`, in all groups that have it, excepts all
/// that it reaches. `kinds` are those that stand for the components of files.
pub(super) fn name_kinds(model: &mut Model, kinds: &HashSet<&str>) {
    let mut everyone = std::mem::take(&mut model.everyone);
    let kind_of = |component: &ComponentModel| {
        component.kind.as_ref().map(|kind| kind.value.clone()).filter(|kind| kinds.contains(kind.as_str()))
    };
    let mut by_name: HashMap<&str, String> = HashMap::new();
    let mut of_kind: HashMap<String, Vec<&ComponentModel>> = HashMap::new();
    for component in &model.components {
        if let Some(kind) = kind_of(component) {
            by_name.insert(&component.name.value, kind.clone());
            of_kind.entry(kind).or_default().push(component);
        }
    }
    let mut entries: HashMap<Span, Excepted> = HashMap::new();
    for entry in &everyone {
        let found = entries.entry(entry.gate.name.span).or_default();
        found.names.extend(entry.except.iter().map(|name| name.value.clone()));
        found.groups.insert(entry.group);
    }
    for entry in &mut everyone {
        let Some(excepted) = entries.get_mut(&entry.gate.name.span) else { continue };
        for name in &mut entry.except {
            let Some(kind) = by_name.get(name.value.as_str()) else { continue };
            let components = of_kind.get(kind).map_or(&[][..], Vec::as_slice);
            if excepted.has_all(kind, components, model) {
                name.value.clone_from(kind);
            }
        }
        // Several components of the kind may be named.
        let mut names = HashSet::new();
        entry.except.retain(|name| names.insert(name.value.clone()));
    }
    model.everyone = everyone;
}

/// What an entry excepts in all groups that have it.
#[derive(Default)]
struct Excepted {
    names: HashSet<String>,
    groups: HashSet<usize>,
    /// What is known of kinds already.
    kinds: HashMap<String, bool>,
}

impl Excepted {
    /// Whether all components of a kind that the entry reaches are excepted.
    fn has_all(&mut self, kind: &str, components: &[&ComponentModel], model: &Model) -> bool {
        if let Some(known) = self.kinds.get(kind) {
            return *known;
        }
        let is_reached = |it: &ComponentModel| model.around(it.group).any(|group| self.groups.contains(&group));
        let has_all = components.iter().filter(|it| is_reached(it)).all(|it| self.names.contains(&it.name.value));
        self.kinds.insert(kind.to_owned(), has_all);
        has_all
    }
}
