//! What the ends of connections in a scope name.

use super::export::{Export, Exports};
use crate::kinds::each_of;
use crate::model::{ComponentModel, Model};
use crate::suggest::similar;
use scl_text::gate_name::split;
use std::collections::HashMap;

/// The names that are known in a scope.
pub(super) struct Names<'a> {
    pub(super) own: &'a Model,
    /// What stands before the names of its components in the whole system: `left_arm.`.
    pub(super) prefix: &'a str,
    /// What stands before the names of its kinds: `arm.`.
    pub(super) stem: &'a str,
    pub(super) groups: &'a HashMap<String, Known>,
    /// Its components, if there are groups or exports.
    components: HashMap<&'a str, &'a ComponentModel>,
    /// Its kinds, if there are groups or exports.
    kinds: HashMap<&'a str, &'a ComponentModel>,
}

/// A group in the scope.
pub(super) struct Known {
    pub(super) exports: Exports,
    /// What stands before the names of the kinds of its file: `arm.`.
    pub(super) stem: String,
}

/// An end that begins with the name of a group, and what follows is not exported.
pub(super) struct NotExported<'a> {
    pub(super) group: &'a str,
    pub(super) exports: &'a Exports,
    pub(super) rest: &'a str,
}

impl<'a> Names<'a> {
    pub(super) fn of(own: &'a Model, prefix: &'a str, stem: &'a str, groups: &'a HashMap<String, Known>) -> Self {
        let is_needed = !groups.is_empty() || !own.exports.is_empty();
        let names = |of: &'a [ComponentModel]| {
            of.iter().filter(|_| is_needed).map(|owner| (owner.name.value.as_str(), owner)).collect()
        };
        Self { own, prefix, stem, groups, components: names(&own.components), kinds: names(&own.kinds) }
    }

    /// The full name of what a text of the scope names.
    pub(super) fn full(&self, text: &str) -> String {
        format!("{}{text}", self.prefix)
    }

    /// Whether the scope has a component or kind of this name, or nobody need ask because it has no groups.
    pub(super) fn knows(&self, owner: &str) -> bool {
        self.has_kind(owner) || self.components.contains_key(owner)
    }

    /// Whether the scope declares a kind of this name, or nobody need ask because it has no groups.
    pub(super) fn has_kind(&self, kind: &str) -> bool {
        self.groups.is_empty() || self.kinds.contains_key(kind)
    }

    /// Whether a gate that is exported exists, as far as this stage knows.
    pub(super) fn may_have(&self, gate: &str) -> bool {
        let Some((owner, name)) = split(gate) else { return false };
        let has = |of: &ComponentModel| of.gates_unread || of.gates.iter().any(|it| it.name.value == name);
        let has_it = |component: &&ComponentModel| {
            let kind = component.kind.as_ref().and_then(|kind| self.kinds.get(kind.value.as_str()));
            has(component) || kind.is_some_and(|kind| has(kind))
        };
        self.group(owner).is_some()
            || self.own.components_unread
            || self.own.everyone.iter().any(|entry| entry.gate.name.value == name)
            || self.components.get(owner).is_some_and(has_it)
    }

    /// The exported gate that an end names; `None` if the end is about no group.
    pub(super) fn exported<'t>(&'t self, end: &'t str) -> Option<Result<&'t Export, NotExported<'t>>> {
        if self.groups.is_empty() || each_of(end).is_some() {
            return None;
        }
        let owner = split(end).map(|(owner, _)| owner);
        if owner.is_some_and(|owner| self.components.contains_key(owner)) {
            return None;
        }
        let (group, known, rest) = self.group(end)?;
        let not_exported = || NotExported { group, exports: &known.exports, rest };
        Some(known.exports.get(rest).ok_or_else(not_exported))
    }

    /// The group whose name stands at the start of an end, and the rest.
    fn group<'t>(&'t self, end: &'t str) -> Option<(&'t str, &'t Known, &'t str)> {
        // The name of a group may contain dots.
        let ends = end.match_indices('.').map(|(at, _)| at).chain([end.len()]);
        let mut groups = ends.filter_map(|at| {
            let (group, rest) = end.split_at(at);
            Some((group, self.groups.get(group)?, rest.trim_start_matches('.')))
        });
        groups.next()
    }

    /// The exports that the end of an unknown component may mean: of a group with a similar name, or of a file instead
    /// of its groups, or the gate as the file of a group calls it.
    pub(super) fn meant_by(&self, end: &str, owner: &str, gate: &str) -> Vec<String> {
        let near = similar(owner, self.groups.keys().map(String::as_str));
        let mut meant: Vec<String> = Vec::new();
        for (group, known) in self.groups {
            let is_near = near.contains(&group.as_str()) || known.stem.strip_suffix('.') == Some(owner);
            if is_near && known.exports.contains_key(gate) {
                meant.push(format!("{group}.{gate}"));
            }
            let inside = self.full(&format!("{group}.{end}"));
            let same = known.exports.iter().filter(|(_, export)| export.gate == inside);
            meant.extend(same.map(|(name, _)| format!("{group}.{name}")));
        }
        meant.sort_unstable();
        meant.dedup();
        meant
    }
}
