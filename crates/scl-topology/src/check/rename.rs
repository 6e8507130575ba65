//! Changes of names: a proposal renames the declaration and every end of a connection that names it.

use super::named::Noun;
use crate::diagnostic::Edit;
use crate::model::{ComponentModel, Model};
use crate::source::{Sources, Span};
use std::collections::HashMap;

/// The ends of connections by what they name.
pub(super) struct Renames<'m> {
    sources: &'m Sources,
    /// The component that each gate name, by its place, belongs to.
    owners: HashMap<Span, &'m ComponentModel>,
    /// The ends of a component: their places, and their gates.
    by_component: HashMap<&'m str, Vec<(Span, &'m str)>>,
    by_gate: HashMap<(&'m str, &'m str), Vec<Span>>,
}

impl<'m> Renames<'m> {
    pub(super) fn of(model: &'m Model, sources: &'m Sources) -> Self {
        let gates = |component: &'m ComponentModel| component.gates.iter().map(move |gate| (gate.name.span, component));
        let owners = model.components.iter().flat_map(gates).collect();
        let mut renames = Self { sources, owners, by_component: HashMap::new(), by_gate: HashMap::new() };
        for end in model.connections.iter().flat_map(|connection| &connection.ends) {
            // A wrong name may contain dots.
            let splits = [end.value.split_once('.'), end.value.rsplit_once('.')];
            let is_same = splits[0] == splits[1];
            for (component, gate) in splits.into_iter().take(if is_same { 1 } else { 2 }).flatten() {
                renames.by_component.entry(component).or_default().push((end.span, gate));
                renames.by_gate.entry((component, gate)).or_default().push(end.span);
            }
        }
        renames
    }

    /// The changes that give a declared component or gate the name `to`.
    pub(super) fn edits(&self, noun: Noun, name: &'m super::named::Name, to: &str) -> Vec<Edit> {
        let edit = |span: Span, text: &str| Edit::new(span, self.sources.quoted_as(span, text));
        let mut edits = vec![edit(name.span, to)];
        match noun {
            Noun::System => {}
            Noun::Component => {
                let ends = self.by_component.get(name.value.as_str()).into_iter().flatten();
                edits.extend(ends.map(|(span, gate)| edit(*span, &format!("{to}.{gate}"))));
            }
            Noun::Gate => {
                let owner = self.owners.get(&name.span).map_or("", |owner| owner.name.value.as_str());
                let ends = self.by_gate.get(&(owner, name.value.as_str())).into_iter().flatten();
                edits.extend(ends.map(|span| edit(*span, &format!("{owner}.{to}"))));
            }
        }
        edits
    }
}
