//! Changes of names: a proposal renames the declaration and everything that names it.

use super::named::{Name, Noun};
use crate::diagnostic::Edit;
use crate::kinds::each_end;
use crate::model::{ComponentModel, ConnectionModel, Model};
use crate::source::{Sources, Span};
use std::collections::HashMap;

/// The places of names by what they name.
pub(super) struct Renames<'m> {
    sources: &'m Sources,
    /// The component or kind that each gate name, by its place, belongs to.
    owners: HashMap<Span, &'m ComponentModel>,
    /// The kinds of components, by the names of the components.
    kinds: HashMap<&'m str, &'m str>,
    /// The components of a kind: the places of the kind's name.
    of_kind: HashMap<&'m str, Vec<Span>>,
    /// The ends of a component, or those with `each` of a kind: their places, and their gates.
    ends: HashMap<Owner<'m>, Vec<(Span, &'m str)>>,
    /// The ends by the gate that they name, and the component or kind that declares it: their places, and what they
    /// name in the place of the component.
    by_gate: HashMap<(&'m str, &'m str), Vec<(Span, Owner<'m>)>>,
    /// The components and kinds that `except` names.
    excepted: HashMap<&'m str, Vec<Span>>,
}

/// What stands before the dot of an end.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Owner<'m> {
    Component(&'m str),
    Each(&'m str),
}

impl Owner<'_> {
    fn end(self, gate: &str) -> String {
        match self {
            Owner::Component(name) => format!("{name}.{gate}"),
            Owner::Each(kind) => each_end(kind, gate),
        }
    }
}

impl<'m> Renames<'m> {
    pub(super) fn of(model: &'m Model, sources: &'m Sources) -> Self {
        let gates = |owner: &'m ComponentModel| owner.gates.iter().map(move |gate| (gate.name.span, owner));
        let mut renames = Self {
            sources,
            owners: model.owners().flat_map(gates).collect(),
            kinds: HashMap::new(),
            of_kind: HashMap::new(),
            ends: HashMap::new(),
            by_gate: HashMap::new(),
            excepted: HashMap::new(),
        };
        for name in model.everyone.iter().flat_map(|shared| &shared.except) {
            renames.excepted.entry(&name.value).or_default().push(name.span);
        }
        for component in &model.components {
            if let Some(kind) = &component.kind {
                renames.kinds.insert(&component.name.value, &kind.value);
                renames.of_kind.entry(&kind.value).or_default().push(kind.span);
            }
        }
        model.connections.iter().for_each(|connection| renames.add(connection));
        renames
    }

    fn add(&mut self, connection: &'m ConnectionModel) {
        // The first end of a connection from `everyone` is not written.
        let written = connection.ends.iter().zip(&connection.each).skip(usize::from(connection.from_everyone));
        for (end, each) in written {
            // A wrong name may contain dots.
            let splits = [end.value.split_once('.'), end.value.rsplit_once('.')];
            let is_same = splits[0] == splits[1];
            for (component, gate) in splits.into_iter().take(if is_same { 1 } else { 2 }).flatten() {
                let owner = each.as_deref().map_or(Owner::Component(component), Owner::Each);
                let declared = self.kinds.get(component).copied().unwrap_or(component);
                add_once(self.ends.entry(owner).or_default(), (end.span, gate));
                add_once(self.by_gate.entry((declared, gate)).or_default(), (end.span, owner));
            }
        }
    }

    /// The changes that give a declared kind, component or gate the name `to`.
    pub(super) fn edits(&self, noun: Noun, name: &'m Name, to: &str) -> Vec<Edit> {
        let edit = |span: Span, text: &str| Edit::new(span, self.sources.quoted_as(span, text));
        let mut edits = vec![edit(name.span, to)];
        let ends = |owner| self.ends.get(&owner).into_iter().flatten();
        if noun.is_type() {
            let excepted = self.excepted.get(name.value.as_str()).into_iter().flatten();
            edits.extend(excepted.map(|span| edit(*span, to)));
        }
        match noun {
            // Nothing else in the file names them.
            Noun::System | Noun::Parameter => {}
            Noun::Component => {
                let ends = ends(Owner::Component(&name.value));
                edits.extend(ends.map(|(span, gate)| edit(*span, &Owner::Component(to).end(gate))));
            }
            Noun::Kind => {
                let components = self.of_kind.get(name.value.as_str()).into_iter().flatten();
                edits.extend(components.map(|span| edit(*span, to)));
                let ends = ends(Owner::Each(&name.value));
                edits.extend(ends.map(|(span, gate)| edit(*span, &Owner::Each(to).end(gate))));
            }
            Noun::Gate => {
                let owner = self.owners.get(&name.span).map_or("", |owner| owner.name.value.as_str());
                let ends = self.by_gate.get(&(owner, name.value.as_str())).into_iter().flatten();
                edits.extend(ends.map(|(span, owner)| edit(*span, &owner.end(to))));
            }
        }
        edits
    }
}

/// Adds a place, unless it is the last one: the connections that one `each` stands for follow each other.
fn add_once<T: PartialEq>(places: &mut Vec<T>, place: T) {
    if places.last() != Some(&place) {
        places.push(place);
    }
}
