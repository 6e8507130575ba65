//! The gates and connections of a kind exist once in the file, and once for each component of the kind: a problem that
//! all these have is one problem.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{ComponentModel, Model};
use crate::source::Span;
use scl_text::list::listed;
use std::collections::HashMap;

/// Merges the problems of one rule at one place of a kind, or of a connection with `each`.
pub(super) fn tell_once(model: &Model, problems: &mut Diagnostics) {
    if model.kinds.is_empty() {
        return;
    }
    let places = Places::of(model);
    let mut about: HashMap<Place, Vec<&ComponentModel>> = HashMap::new();
    problems.retain(|found| {
        let Some(place) = places.place(found) else { return true };
        let is_first = !about.contains_key(&place);
        let components = about.entry(place).or_default();
        let component =
            places.component(found).filter(|it| components.last().is_none_or(|last| !std::ptr::eq(*it, *last)));
        components.extend(component);
        is_first
    });
    problems.retain(|found| {
        let components = places.place(found).and_then(|place| about.remove(&place)).unwrap_or_default();
        found.notes.extend(places.note(&components));
        true
    });
}

/// A rule, and the place where it found something.
type Place = (&'static str, Span);

struct Places<'m> {
    /// The components of kinds, by their names.
    components: HashMap<&'m str, &'m ComponentModel>,
    /// How many components each kind has.
    numbers: Vec<usize>,
    /// The kinds, and the connections with `each`, sorted. None overlaps another.
    shared: Vec<Span>,
}

impl<'m> Places<'m> {
    fn of(model: &'m Model) -> Self {
        let mut numbers = vec![0; model.kinds.len()];
        let mut components = HashMap::new();
        for component in &model.components {
            if let Some(kind) = component.of {
                numbers[kind] += 1;
                components.insert(component.name.value.as_str(), component);
            }
        }
        let each = model.connections.iter().filter(|connection| connection.each.iter().any(Option::is_some));
        let each = each.map(|connection| connection.span);
        let mut shared: Vec<Span> = model.kinds.iter().map(|kind| kind.span).chain(each).collect();
        shared.sort_unstable();
        shared.dedup();
        Self { components, numbers, shared }
    }

    /// The rule and the place of a problem, if several components may have it there.
    fn place(&self, found: &Diagnostic) -> Option<Place> {
        let at = found.primary.as_ref()?.span;
        let next = self.shared.partition_point(|shared| (shared.file, shared.start) <= (at.file, at.start));
        let shared = self.shared.get(next.checked_sub(1)?)?;
        (shared.file == at.file && at.end <= shared.end).then(|| (found.code(), at))
    }

    /// The component of a kind that a problem names.
    fn component(&self, found: &Diagnostic) -> Option<&'m ComponentModel> {
        let words = found.message.split('`').skip(1).step_by(2);
        words.filter_map(|word| self.components.get(word.split('.').next()?).copied()).next()
    }

    /// Says which components have a problem, if it names one of several.
    fn note(&self, components: &[&ComponentModel]) -> Option<String> {
        let all = *self.numbers.get(components.first()?.of?)?;
        let names = listed(components.iter().map(|component| &component.name.value));
        match components.len() {
            1 => None,
            some if some == all => Some(format!("all {all} components of the kind have it: {names}")),
            some => Some(format!("{some} of the {all} components of the kind have it: {names}")),
        }
    }
}
