//! The gates and connections of a kind exist once in the file, and once for each component of the kind, as those of
//! `everyone` exist once for every component: a problem that all these have is one problem.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{ComponentModel, Model};
use crate::source::{FileId, Span};
use scl_text::gate_name::component_and_gate;
use scl_text::list::listed;
use std::collections::{HashMap, HashSet};

/// Merges the problems of one rule at one place of a kind, of a connection with `each`, or of an entry of `everyone`.
pub(super) fn tell_once(model: &Model, problems: &mut Diagnostics) {
    if model.kinds.is_empty() && model.everyone.is_empty() && model.groups.len() < 2 {
        return;
    }
    let places = Places::of(model);
    // The components that each of the problems names.
    let mut about: HashMap<Place, Vec<Vec<&ComponentModel>>> = HashMap::new();
    problems.retain(|found| {
        let Some(place) = places.place(found) else { return true };
        let told = about.entry(place).or_default();
        told.push(places.components(found));
        told.len() == 1
    });
    problems.retain(|found| {
        let told = places.place(found).and_then(|place| about.remove(&place)).unwrap_or_default();
        found.notes.extend(places.note(&different(&told)));
        true
    });
}

/// Of the components that each problem names, the first that not all of them name.
fn different<'m>(told: &[Vec<&'m ComponentModel>]) -> Vec<&'m ComponentModel> {
    let mut numbers: HashMap<&str, usize> = HashMap::new();
    for component in told.iter().flatten() {
        *numbers.entry(&component.name.value).or_default() += 1;
    }
    let is_common = |component: &&ComponentModel| numbers.get(component.name.value.as_str()) == Some(&told.len());
    let mut different: Vec<&ComponentModel> = Vec::new();
    for component in told.iter().filter_map(|named| named.iter().copied().find(|it| !is_common(it))) {
        // A component may have several problems at one place.
        if different.last().is_none_or(|last| !std::ptr::eq(*last, component)) {
            different.push(component);
        }
    }
    different
}

/// A rule, and the place where it found something.
type Place = (&'static str, Span);

struct Places<'m> {
    /// The components by their names.
    components: HashMap<&'m str, &'m ComponentModel>,
    /// How many components each kind has.
    numbers: Vec<usize>,
    /// The kinds, the connections with `each` and the gates of `everyone`, sorted. None overlaps another.
    shared: Vec<Span>,
    /// The files that have become groups, with those that they include: all that is declared in a group.
    in_groups: HashSet<FileId>,
}

impl<'m> Places<'m> {
    fn of(model: &'m Model) -> Self {
        let mut numbers = vec![0; model.kinds.len()];
        model.components.iter().filter_map(|component| component.of).for_each(|kind| numbers[kind] += 1);
        let components = model.components.iter().map(|component| (component.name.value.as_str(), component)).collect();
        let each = model.connections.iter().filter(|connection| connection.each.iter().any(Option::is_some));
        let each = each.map(|connection| connection.span);
        let everyone = model.everyone.iter().map(|entry| entry.gate.span);
        let mut shared: Vec<Span> = model.kinds.iter().map(|kind| kind.span).chain(each).chain(everyone).collect();
        shared.sort_unstable();
        shared.dedup();
        let in_groups = model.components.iter().filter(|component| component.group > 0);
        let in_groups = in_groups.map(|component| component.span.file);
        let of_groups = model.groups.iter().filter_map(|group| group.file);
        Self { components, numbers, shared, in_groups: in_groups.chain(of_groups).collect() }
    }

    /// The rule and the place of a problem, if several components may have it there.
    fn place(&self, found: &Diagnostic) -> Option<Place> {
        let at = found.primary.as_ref()?.span;
        if self.in_groups.contains(&at.file) {
            return Some((found.code(), at));
        }
        let next = self.shared.partition_point(|shared| (shared.file, shared.start) <= (at.file, at.start));
        let shared = self.shared.get(next.checked_sub(1)?)?;
        (shared.file == at.file && at.end <= shared.end).then(|| (found.code(), at))
    }

    /// The components that a problem names, each once.
    fn components(&self, found: &Diagnostic) -> Vec<&'m ComponentModel> {
        let mut named: Vec<&ComponentModel> = Vec::new();
        for word in found.message.split('`').skip(1).step_by(2) {
            let is_component = |name: &str| self.components.contains_key(name);
            let component = self.components.get(component_and_gate(word, is_component).0);
            named.extend(component.filter(|it| !named.iter().any(|known| std::ptr::eq(*known, **it))));
        }
        named
    }

    /// Says which components have a problem, if several have it.
    fn note(&self, components: &[&ComponentModel]) -> Option<String> {
        let (first, number) = (components.first()?, components.len());
        let names = listed(components.iter().map(|component| &component.name.value));
        let of_kind = first.of.filter(|kind| components.iter().all(|component| component.of == Some(*kind)));
        match of_kind.map(|kind| self.numbers[kind]) {
            _ if number == 1 => None,
            Some(all) if number == all => Some(format!("all {all} components of the kind have it: {names}")),
            Some(all) => Some(format!("{number} of the {all} components of the kind have it: {names}")),
            None => Some(format!("{number} components have it: {names}")),
        }
    }
}
