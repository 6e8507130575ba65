//! The names in an entry of `everyone`: `to` and `except`. SCL1402 to SCL1404.

use super::{Checked, NO_TO};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::grammar::EVERYONE;
use crate::kinds::{choose, each_of};
use crate::model::{ComponentModel, Model, SharedGateModel};
use crate::source::{Sources, Span, Spanned};
use crate::suggest::Searches;
use scl_text::gate_name::split;
use scl_text::list::listed;
use std::collections::{HashMap, HashSet};

/// SCL1402.
pub(super) const UNKNOWN_TO: Rule = Rule {
    code: "SCL1402",
    severity: Severity::Error,
    title: "`to` names no gate",
    explanation: "`to` is the gate of one component at the other end: `component.gate`. No component has the gate that \
                  it names.",
    example: " components:
   - {name: sensor, gates: []}
   - name: logger
     gates:
       - records: {pull: Record}
 everyone:
-  - log: {push: Record, to: logger.record}
+  - log: {push: Record, to: logger.records}
",
};

/// SCL1403.
pub(super) const UNKNOWN_EXCEPT: Rule = Rule {
    code: "SCL1403",
    severity: Severity::Error,
    title: "`except` names no component",
    explanation: "`except` lists the components that do not get the gate. All components of a kind have the same gates, \
                  so it names the kind, not one of them.",
    example: " components:
   - {name: sensor, gates: []}
   - {name: camera, gates: []}
   - name: logger
     gates:
       - records: {pull: Record}
 everyone:
-  - log: {push: Record, to: logger.records, except: [kamera]}
+  - log: {push: Record, to: logger.records, except: [camera]}
",
};

/// SCL1404.
pub(super) const NEEDLESS_EXCEPT: Rule = Rule {
    code: "SCL1404",
    severity: Severity::Warning,
    title: "needless name in `except`",
    explanation: "The component would not get the gate without it: it is the owner of the gate at the other end, or is \
                  named twice. Remove the name.",
    example: " components:
   - {name: sensor, gates: []}
   - name: logger
     gates:
       - records: {pull: Record}
 everyone:
-  - log: {push: Record, to: logger.records, except: [logger]}
+  - log: {push: Record, to: logger.records}
",
};

/// The declarations of a file.
pub(super) struct Known<'m> {
    model: &'m Model,
    sources: &'m Sources,
    components: HashMap<&'m str, &'m ComponentModel>,
    kinds: HashMap<&'m str, &'m ComponentModel>,
    /// The places of gates by the number of their owner (first the kinds, then the components) and their names.
    gates: HashMap<(usize, &'m str), Span>,
    searches: Searches,
}

impl<'m> Known<'m> {
    pub(super) fn of(model: &'m Model, sources: &'m Sources) -> Self {
        let by_name = |of: &'m [ComponentModel]| of.iter().map(|owner| (owner.name.value.as_str(), owner)).collect();
        let owners = model.kinds.iter().chain(&model.components).enumerate();
        let gates = owners.flat_map(|(at, owner)| {
            owner.gates.iter().map(move |gate| ((at, gate.name.value.as_str()), gate.name.span))
        });
        Self {
            model,
            sources,
            components: by_name(&model.components),
            kinds: by_name(&model.kinds),
            gates: gates.collect(),
            searches: Searches::default(),
        }
    }

    /// The place of a gate of a kind or component.
    pub(super) fn gate(&self, owner: usize, name: &str) -> Option<Span> {
        self.gates.get(&(owner, name)).copied()
    }

    /// Checks the names of an entry.
    pub(super) fn check(&mut self, entry: &'m SharedGateModel, problems: &mut Diagnostics) -> Checked<'m> {
        let to = entry.to.as_ref();
        if to.is_none() && !entry.unread {
            let name = &entry.gate.name;
            let found = NO_TO.at(format!("gate `{}` of `{EVERYONE}` has no `to`", name.value), name.span, "");
            problems.push(found.help("`to: logger.records` names the gate at the other end"));
        }
        let owner = to.and_then(|to| split(&to.value)).map(|(component, _)| component);
        let kind = owner.and_then(|owner| self.kind_of(owner)).map(|kind| kind.name.value.as_str());
        let mut names: HashSet<&str> = owner.into_iter().chain(kind).collect();
        for name in &entry.except {
            self.check_except(name, &names, problems);
            names.insert(&name.value);
        }
        Checked { left_out: names, to: to.filter(|to| self.check_to(to, problems)) }
    }

    /// The kind of a component.
    fn kind_of(&self, component: &str) -> Option<&'m ComponentModel> {
        self.kinds.get(self.components.get(component)?.kind.as_ref()?.value.as_str()).copied()
    }

    /// Whether the gate at the other end exists, as far as it is known.
    fn check_to(&mut self, to: &Spanned<String>, problems: &mut Diagnostics) -> bool {
        if each_of(&to.value).is_some() {
            let found = UNKNOWN_TO.at("`to` is one gate, not one of each component of a kind", to.span, "");
            problems.push(self.choose(found, to, Vec::new()));
            return false;
        }
        let Some((name, gate)) = split(&to.value) else {
            let found = UNKNOWN_TO.at("`to` is written `component.gate`", to.span, "");
            problems.push(self.choose(found, to, Vec::new()));
            return false;
        };
        let Some(owner) = self.components.get(name) else {
            if !self.model.components_unread && !self.model.cut_off {
                let model = self.model;
                let near =
                    self.searches.similar(name, model.components.iter().map(|component| component.name.value.as_str()));
                let ways = near.iter().map(|name| format!("{name}.{gate}"));
                let found = UNKNOWN_TO.at(format!("unknown component `{name}`"), to.span, "");
                let found = self.choose(found, to, ways.collect());
                problems.push(match self.kinds.contains_key(name) {
                    true => found.note(format!("`{name}` is a kind; `to` names a gate of one component")),
                    false => found,
                });
            }
            return false;
        };
        let declares = self.kind_of(name).unwrap_or(owner);
        let gates = || declares.gates.iter().map(|gate| gate.name.value.as_str());
        let exists = gates().any(|known| known == gate);
        if !exists && !declares.gates_unread {
            let near = self.searches.similar(gate, gates());
            let found = UNKNOWN_TO.at(format!("component `{name}` has no gate `{gate}`"), to.span, "");
            let found = self.choose(found, to, near.iter().map(|gate| format!("{name}.{gate}")).collect());
            problems.push(match declares.gates.is_empty() {
                true => found.label(declares.name.span, "it has no gates"),
                false => found.note(format!("gates of `{name}`: {}", listed(gates()))),
            });
        }
        exists
    }

    fn check_except(&mut self, name: &Spanned<String>, left_out: &HashSet<&str>, problems: &mut Diagnostics) {
        let word = name.value.as_str();
        let is_known = self.kinds.contains_key(word) || self.components.contains_key(word);
        if left_out.contains(word) {
            let found = NEEDLESS_EXCEPT.at(format!("`{word}` needs no exception"), name.span, "");
            let file = self.sources.file(name.span.file);
            problems.push(found.propose_removal("remove it: it does not get the gate", file, name.span));
        } else if let Some(kind) = self.kind_of(word) {
            let kind = &kind.name.value;
            let message = format!("`{word}` is of kind `{kind}`, whose components all have the same gates");
            let edit = Edit::new(name.span, self.sources.quoted_as(name.span, kind));
            let found = UNKNOWN_EXCEPT.at(message, name.span, "");
            problems.push(found.suggest(format!("write `{kind}`: none of them gets the gate"), [edit]));
        } else if !is_known && !self.model.components_unread && !self.model.kinds_unread {
            let model = self.model;
            // `camera.log`: the gate with its component.
            let gate_of = split(word).map(|(owner, _)| owner);
            let near = match gate_of.filter(|owner| self.components.contains_key(owner)) {
                Some(owner) => vec![owner],
                None => self.searches.similar(word, model.owners().map(|owner| owner.name.value.as_str())),
            };
            let found = UNKNOWN_EXCEPT.at(format!("unknown component `{word}`"), name.span, "");
            problems.push(found.did_you_mean(word, &near).otherwise("`except` lists components and kinds"));
        }
    }

    fn choose(&self, found: Diagnostic, to: &Spanned<String>, ways: Vec<String>) -> Diagnostic {
        choose(found, to.span, ways.into_iter(), self.sources)
            .otherwise("`to` names a gate that a component declares: `logger.records`")
    }
}
