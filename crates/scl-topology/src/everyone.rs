//! Gates of every component: an entry of `everyone` becomes a gate of each component and of each kind, and a connection
//! of each of these gates. SCL1401, SCL1405 and SCL1406.
//!
//! This runs before kinds are written out, so that the components of a kind get the gate of their kind.

mod names;
#[cfg(test)]
mod tests;

use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::grammar::EVERYONE;
use crate::kinds::{MOST, each_end, too_many};
use crate::model::{ConnectionModel, GateModel, Model, SharedGateModel};
use crate::source::{Sources, Span, Spanned};
use names::Known;
use std::collections::{HashMap, HashSet};

/// The rules of this stage, by their codes.
pub(crate) const RULES: &[&Rule] =
    &[&NO_TO, &names::UNKNOWN_TO, &names::UNKNOWN_EXCEPT, &names::NEEDLESS_EXCEPT, &TAKEN, &NOBODY];

/// SCL1401.
const NO_TO: Rule = Rule {
    code: "SCL1401",
    severity: Severity::Error,
    title: "gate in `everyone` without `to`",
    explanation: "Each component gets the gate, and each of these gates is connected to the gate that `to` names. \
                  Add `to: component.gate`.",
    example: " components:
   - {name: sensor, gates: []}
   - name: logger
     gates:
       - records: {pull: Record}
 everyone:
-  - log: {push: Record}
+  - log: {push: Record, to: logger.records}
",
};

/// SCL1405.
const TAKEN: Rule = Rule {
    code: "SCL1405",
    severity: Severity::Error,
    title: "name of a gate in `everyone` is taken",
    explanation: "A component would have two gates of this name: its own, and that of `everyone`. Rename one, or list \
                  the component in `except`.",
    example: " components:
   - name: sensor
     gates:
-      - log: {pub: Record, unconnected: ok}
+      - records: {pub: Record, unconnected: ok}
   - name: logger
     gates:
       - records: {pull: Record}
 everyone:
   - log: {push: Record, to: logger.records}
",
};

/// SCL1406.
const NOBODY: Rule = Rule {
    code: "SCL1406",
    severity: Severity::Warning,
    title: "gate in `everyone` that no component gets",
    explanation: "All components are excepted, or own the gate at the other end, so the entry has no effect. Remove \
                  it, or an exception.",
    example: "",
};

/// Gives each component and each kind the gates of `everyone`, and connects them.
pub(crate) fn expand(model: &mut Model, sources: &Sources, problems: &mut Diagnostics) {
    if model.everyone.is_empty() {
        return;
    }
    let Added { gates, connections, broken, is_cut_off, .. } = Added::of(model, sources, problems);
    let kinds = model.kinds.len();
    for (owner, gate) in gates {
        match owner.checked_sub(kinds) {
            Some(component) => model.components[component].gates.push(gate),
            None => model.kinds[owner].gates.push(gate),
        }
    }
    model.connections.extend(connections);
    model.broken_ends.extend(broken);
    model.cut_off |= is_cut_off;
}

/// What the entries add to the model.
#[derive(Default)]
struct Added {
    /// The gates with their owners: first the kinds, then the components.
    gates: Vec<(usize, GateModel)>,
    /// The owners with the places of the gates that they have got.
    added: HashSet<(usize, Span)>,
    connections: Vec<ConnectionModel>,
    /// Gates whose other end is wrong: nobody calls them unconnected.
    broken: Vec<Spanned<String>>,
    /// There are too many, and a problem says so.
    is_cut_off: bool,
}

impl Added {
    fn of(model: &Model, sources: &Sources, problems: &mut Diagnostics) -> Self {
        let mut added = Self::default();
        let mut known = Known::of(model, sources);
        let mut entries: HashMap<(usize, &str), Span> = HashMap::new();
        for entry in &model.everyone {
            let name = &entry.gate.name;
            if let Some(first) = entries.insert((entry.group, &name.value), name.span) {
                let found = TAKEN.at(format!("`{EVERYONE}` has two gates `{}`", name.value), name.span, "second one");
                problems.push(found.label(first, "first one").help("rename one of the two"));
                continue;
            }
            let checked = known.check(entry, problems);
            if !added.add(entry, &checked, model, &known, problems) {
                problems.push(too_many(name.span, "gates"));
                added.is_cut_off = true;
                break;
            }
        }
        added
    }

    /// Adds the gates of an entry; false if there are too many.
    fn add(
        &mut self,
        entry: &SharedGateModel,
        checked: &Checked<'_>,
        model: &Model,
        known: &Known<'_>,
        problems: &mut Diagnostics,
    ) -> bool {
        let name = &entry.gate.name;
        let mut number = 0_usize;
        let in_group = model.components.iter().filter(|component| model.is_within(component.group, entry.group));
        let kinds_in_group: HashSet<&str> = in_group.filter_map(|it| Some(it.kind.as_ref()?.value.as_str())).collect();
        for (at, owner) in model.kinds.iter().chain(&model.components).enumerate() {
            let is_kind = at < model.kinds.len();
            let is_in_group = match is_kind {
                true => entry.group == 0 || kinds_in_group.contains(owner.name.value.as_str()),
                false => model.is_within(owner.group, entry.group),
            };
            if !is_in_group {
                continue;
            }
            // The components of a kind get the gate of the kind.
            let has_kind = !is_kind && owner.kind.is_some();
            let of = owner.name.value.as_str();
            if has_kind || checked.left_out.contains(of) {
                continue;
            }
            number += 1;
            if let Some(own) = known.gate(at, &name.value) {
                problems.push(taken(entry, of, own));
                continue;
            }
            if self.gates.len() == MOST {
                return false;
            }
            // A file may have become several groups, of which each has the entry, and whose components are of one kind.
            if self.added.insert((at, name.span)) {
                self.gates.push((at, entry.gate.clone()));
            }
            let end = if is_kind { each_end(of, &name.value) } else { format!("{of}.{}", name.value) };
            let end = Spanned { value: end, span: name.span };
            match checked.to {
                Some(to) => {
                    let connection = ConnectionModel::new([end, to.clone()], entry.gate.span);
                    let group = entry.group;
                    self.connections.push(ConnectionModel { from_everyone: true, group, ..connection });
                }
                None => self.broken.push(end),
            }
        }
        if number == 0 && !model.components.is_empty() && !model.components_unread && !model.cut_off {
            let found = NOBODY.at(format!("no component gets the gate `{}`", name.value), name.span, "has no effect");
            problems.push(found.help("remove it, or an exception"));
        }
        true
    }
}

/// What is known of an entry before its gates are added.
struct Checked<'m> {
    /// The components and kinds that do not get the gate.
    left_out: HashSet<&'m str>,
    /// The gate at the other end, if there is one.
    to: Option<&'m Spanned<String>>,
}

fn taken(entry: &SharedGateModel, owner: &str, own: Span) -> Diagnostic {
    let name = &entry.gate.name;
    TAKEN
        .at(format!("`{owner}` has a gate `{}` of its own", name.value), own, "")
        .label(name.span, format!("`{EVERYONE}` gives every component one"))
        .help(format!("rename one of the two, or write `except: [{owner}]`"))
}
