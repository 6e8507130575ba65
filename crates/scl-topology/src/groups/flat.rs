//! Writes out the groups of a system.

use super::ends::{Known, Names};
use super::export::{Export, Exports};
use super::lift::{Origin, lift};
use super::{Scope, rules};
use crate::diagnostic::{Diagnostic, Diagnostics, Told};
use crate::join::add_paths;
use crate::kinds::{MOST, each_end, each_of, too_many};
use crate::model::{ComponentModel, ExportModel, GroupModel, Model};
use crate::source::{FileId, Sources, Span, Spanned};
use crate::spelling::is_well_formed_in_groups;
use crate::suggest::Searches;
use scl_text::gate_name::split;
use std::collections::{HashMap, HashSet};

/// Writes out the groups: the result has all components with their full names, and all connections.
pub fn flatten(scope: Scope, sources: &Sources, problems: &mut Diagnostics) -> Model {
    if scope.groups.is_empty() && scope.model.exports.is_empty() {
        return scope.model;
    }
    let mut flat = Flat {
        model: Model { groups: vec![GroupModel::default()], ..Model::default() },
        origins: Vec::new(),
        kinds: HashSet::new(),
        stems: HashSet::new(),
        files: HashSet::new(),
        exports: Vec::new(),
        used: HashSet::new(),
        told: Told::default(),
        left: MOST,
        searches: Searches::default(),
        sources,
        problems,
    };
    flat.add(&scope, 0, "", "");
    flat.report_unused();
    let Flat { mut model, origins, problems, .. } = flat;
    lift(&mut model, &origins, problems);
    model
}

/// The result so far.
struct Flat<'a> {
    model: Model,
    /// Where each component comes from.
    origins: Vec<Origin>,
    /// The kinds that were added, by their places and the words before their names.
    kinds: HashSet<(Span, String)>,
    /// What stands before the names of the kinds of groups.
    stems: HashSet<String>,
    /// The files whose comments for the checker were added.
    files: HashSet<FileId>,
    /// The exports of all groups with their names.
    exports: Vec<(String, Export)>,
    /// The places of the exports that are connected in one of the groups.
    used: HashSet<Span>,
    /// What is reported already, for another group of the same file.
    told: Told,
    /// How many groups, gates and connections groups may still stand for.
    left: usize,
    searches: Searches,
    sources: &'a Sources,
    problems: &'a mut Diagnostics,
}

impl Flat<'_> {
    /// Adds a system or the group with this number, whose components have `prefix` before their names and whose kinds
    /// have `stem`. Returns its exports.
    fn add(&mut self, scope: &Scope, number: usize, prefix: &str, stem: &str) -> Exports {
        let own = &scope.model;
        self.add_settings(own, number == 0);
        for kind in &own.kinds {
            if self.kinds.insert((kind.name.span, stem.to_owned())) {
                let added = renamed(kind, &kind.name, format!("{stem}{}", kind.name.value));
                self.model.kinds.push(ComponentModel { group: number, ..added });
            }
        }
        let first = self.model.components.len();
        for component in &own.components {
            let mut added = renamed(component, &component.name, format!("{prefix}{}", component.name.value));
            added.group = number;
            if let Some(kind) = &mut added.kind {
                kind.value = format!("{stem}{}", kind.value);
            }
            self.model.components.push(added);
            self.origins.push(Origin { name: format!("{stem}{}", component.name.value), group: stem.to_owned() });
        }
        let groups = self.add_groups(scope, number, prefix);
        let names = Names::of(own, prefix, stem, &groups);
        self.check_kinds(&names, first);
        self.add_connections(&names, number);
        self.add_everyone(&names, number);
        self.own_exports(&names, number)
    }

    /// What does not depend on the group.
    fn add_settings(&mut self, own: &Model, is_whole: bool) {
        if is_whole {
            self.model.system = own.system.clone();
            self.model.codec = own.codec.clone();
        }
        self.model.include.extend(own.include.iter().cloned());
        add_paths(&mut self.model.schemas, own.schemas.clone());
        add_paths(&mut self.model.schema_roots, own.schema_roots.clone());
        let of_new_files = own.controls.iter().filter(|control| !self.files.contains(&control.text.span.file));
        self.model.controls.extend(of_new_files.cloned());
        self.files.extend(own.controls.iter().map(|control| control.text.span.file));
        self.model.connections_key = self.model.connections_key.or(own.connections_key);
        self.model.connections_unread |= own.connections_unread;
        self.model.components_unread |= own.components_unread;
        self.model.kinds_unread |= own.kinds_unread;
        self.model.cut_off |= own.cut_off;
    }

    /// Adds the groups in a scope.
    fn add_groups(&mut self, scope: &Scope, parent: usize, prefix: &str) -> HashMap<String, Known> {
        let mut groups: HashMap<String, Known> = HashMap::new();
        let mut first: HashMap<&str, Span> = HashMap::new();
        let components = scope.model.components.iter().filter(|_| !scope.groups.is_empty());
        let components: HashMap<&str, Span> = components.map(|it| (it.name.value.as_str(), it.name.span)).collect();
        for group in &scope.groups {
            let name = &group.name;
            let fault = match (first.insert(&name.value, name.span), components.get(name.value.as_str())) {
                (Some(first), _) => Some(rules::taken_twice(name, first)),
                (None, Some(component)) => Some(rules::taken_by_component(name, *component)),
                (None, None) if !is_well_formed_in_groups(&name.value) => Some(rules::no_name(name, self.sources)),
                (None, None) => None,
            };
            if let Some(fault) = fault {
                // What names the group is not wrong.
                self.model.components_unread = true;
                self.report(fault);
                continue;
            }
            let Some(left) = self.left.checked_sub(size(&group.scope.model)) else {
                self.model.cut_off = true;
                // Once, for the first group.
                if self.left > 0 {
                    self.report(too_many(name.span, "gates and connections of groups"));
                }
                self.left = 0;
                return groups;
            };
            self.left = left;
            let full = format!("{prefix}{}", name.value);
            let number = self.model.groups.len();
            self.model.groups.push(GroupModel {
                name: full.clone(),
                parent,
                file: Some(group.file),
                at: Some(name.span),
                exports: Vec::new(),
            });
            let stem = format!("{}.", group.stem);
            self.stems.insert(stem.clone());
            let exports = self.add(&group.scope, number, &format!("{full}."), &stem);
            self.exports.extend(exports.iter().map(|(name, export)| (name.clone(), export.clone())));
            groups.insert(name.value.clone(), Known { exports, stem });
        }
        groups
    }

    /// Reports components of kinds that are known in groups only. The `first` of them has been added.
    fn check_kinds(&mut self, names: &Names<'_>, first: usize) {
        for (at, component) in names.own.components.iter().enumerate() {
            let Some(kind) = component.kind.as_ref().filter(|kind| self.is_in_groups(names, &kind.value)) else {
                continue;
            };
            self.report(rules::kind_in_groups(kind));
            let added = &mut self.model.components[first + at];
            (added.kind, added.gates_unread) = (None, true);
        }
    }

    fn add_connections(&mut self, names: &Names<'_>, number: usize) {
        for connection in &names.own.connections {
            let ends = connection.ends.each_ref().map(|end| self.end(names, end));
            if let [Some(first), Some(second)] = ends {
                let mut added = connection.clone();
                (added.ends, added.group) = ([first, second], number);
                self.model.connections.push(added);
            } else {
                self.model.broken_ends.extend(ends.into_iter().flatten());
            }
        }
        let broken = names.own.broken_ends.iter().map(|end| Spanned { value: names.full(&end.value), span: end.span });
        self.model.broken_ends.extend(broken);
    }

    fn add_everyone(&mut self, names: &Names<'_>, number: usize) {
        for entry in &names.own.everyone {
            let mut added = entry.clone();
            added.group = number;
            if let Some(to) = &entry.to {
                added.to = self.end(names, to);
                added.unread |= added.to.is_none();
            }
            for name in &mut added.except {
                let is_kind = names.own.kinds.iter().any(|kind| kind.name.value == name.value);
                name.value = format!("{}{}", if is_kind { names.stem } else { names.prefix }, name.value);
            }
            self.model.everyone.push(added);
        }
    }

    /// The exports of a scope itself.
    fn own_exports(&mut self, names: &Names<'_>, number: usize) -> Exports {
        let mut exports = Exports::new();
        for export in &names.own.exports {
            let name = &export.name;
            if let Some(first) = exports.get(&name.value) {
                self.report(rules::exported_twice(name, first.at));
                continue;
            }
            let Some(gate) = self.end(names, &export.gate) else { continue };
            let is_unknown = !names.may_have(&export.gate.value);
            exports.insert(name.value.clone(), Export { at: name.span, gate: gate.value.clone(), is_unknown });
            let export = ExportModel { name: name.clone(), gate };
            match number {
                // The whole file may become a group elsewhere.
                0 => self.model.exports.push(export),
                _ => self.model.groups[number].exports.push(export),
            }
        }
        exports
    }

    /// The full name of a gate that an end names; `None` if it is in a group and not exported, which is reported.
    fn end(&mut self, names: &Names<'_>, end: &Spanned<String>) -> Option<Spanned<String>> {
        let value = match (names.exported(&end.value), each_of(&end.value).map(split)) {
            (None, None) => {
                if let Some((name, meant)) = self.unknown(names, &end.value) {
                    self.report(rules::unknown(name, end, &meant, self.sources));
                    return None;
                }
                names.full(&end.value)
            }
            (None, Some(Some((kind, _)))) if self.is_in_groups(names, kind) => {
                self.report(rules::each_in_groups(kind, end.span));
                return None;
            }
            (None, Some(Some((kind, gate)))) => each_end(&format!("{}{kind}", names.stem), gate),
            (None, Some(None)) => end.value.clone(),
            (Some(Ok(export)), _) => {
                self.used.insert(export.at);
                if export.is_unknown {
                    return None;
                }
                export.gate.clone()
            }
            (Some(Err(fault)), _) => {
                self.report(rules::not_exported(names, end, &fault, self.sources));
                return None;
            }
        };
        Some(Spanned { value, span: end.span })
    }

    /// Whether a kind is one of the file of groups, and not of the scope's own.
    fn is_in_groups(&self, names: &Names<'_>, kind: &str) -> bool {
        let stem = kind.find('.').map(|at| &kind[..=at]);
        !names.has_kind(kind) && stem.is_some_and(|stem| self.stems.contains(stem))
    }

    /// The name of an end that names no component and no group, and the exports that it may mean.
    fn unknown<'e>(&mut self, names: &Names<'_>, end: &'e str) -> Option<(&'e str, Vec<String>)> {
        let (owner, gate) = split(end)?;
        if names.knows(owner) || self.model.components_unread || !self.searches.may_search() {
            return None;
        }
        let meant = names.meant_by(end, owner, gate);
        (!meant.is_empty()).then_some((owner, meant))
    }

    /// Reports exports that are connected in no group. Nobody need call their gates unconnected, too.
    fn report_unused(&mut self) {
        let is_partial = self.model.cut_off || self.model.connections_unread || self.model.components_unread;
        for (name, Export { at, gate, .. }) in std::mem::take(&mut self.exports) {
            if !self.used.contains(&at) {
                if !is_partial {
                    self.report(rules::unused(&name, at));
                }
                let (name, gate) = (Spanned { value: name, span: at }, Spanned { value: gate, span: at });
                self.model.exports.push(ExportModel { name, gate });
            }
        }
    }

    /// Reports a problem once, although the file may have become several groups.
    fn report(&mut self, problem: Diagnostic) {
        self.told.push(problem, self.problems);
    }
}

/// What a group of this file stands for: itself, its gates and its connections.
fn size(model: &Model) -> usize {
    let gates: usize = model.components.iter().map(|component| 1 + component.gates.len()).sum();
    let everyone: usize = model.everyone.iter().map(|entry| 1 + entry.except.len()).sum();
    1 + gates + model.connections.len() + everyone
}

/// A component or kind with another name in the same place.
fn renamed(of: &ComponentModel, name: &Spanned<String>, value: String) -> ComponentModel {
    ComponentModel { name: Spanned { value, span: name.span }, ..of.clone() }
}
