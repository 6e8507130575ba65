//! Kinds of components: a component with `kind: motor` gets the gates of the kind `motor`, and a connection with
//! `each motor.state` at one end is a connection of each component of the kind.
//!
//! All later stages see components, gates and pairs only, each with its place in the file: the gates of all motors
//! stand at the same place. SCL1302 to SCL1304 are here.

mod each;
#[cfg(test)]
mod tests;
mod unknown;

use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity, removal};
use crate::grammar::KIND;
use crate::model::{ComponentModel, Model};
use crate::source::{Sources, Span, Spanned};
use std::collections::{HashMap, HashSet};

pub(crate) use each::{EACH, choose, each_end, each_of};

/// The rules of this stage, by their codes.
pub(crate) const RULES: &[&Rule] = &[
    &unknown::RULE,
    &OWN_GATES,
    &UNUSED,
    &REPEATED,
    &each::NO_KIND,
    &each::WITHOUT_EACH,
    &each::TWICE,
    &each::NO_GATE,
    &TOO_MANY,
];

/// SCL1302.
const OWN_GATES: Rule = Rule {
    code: "SCL1302",
    severity: Severity::Error,
    title: "component of a kind with gates of its own",
    explanation: "All components of a kind have the same gates, so that one program can run any of them. A component \
                  of a kind has no `gates` of its own. Add the gate to the kind, or give the component all its gates \
                  and no `kind`.",
    example: " kinds:
   - name: motor
     gates:
       - state: {pub: MotorState, unconnected: ok}
 components:
   - name: left_motor
     kind: motor
-    gates: []
 connections: []
",
};

/// SCL1303.
const UNUSED: Rule = Rule {
    code: "SCL1303",
    severity: Severity::Warning,
    title: "kind without components",
    explanation: "No component is of this kind, so nothing in it has an effect, and its gates are not checked. Add a \
                  component with `kind:`, or remove the kind.",
    example: " kinds:
   - name: motor
     gates:
       - state: {pub: MotorState, unconnected: ok}
-components: []
+components:
+  - {name: left_motor, kind: motor}
 connections: []
",
};

/// SCL1304.
const REPEATED: Rule = Rule {
    code: "SCL1304",
    severity: Severity::Error,
    title: "name of a kind is taken",
    explanation: "A kind has the name of another kind, or of a component. Both would become the same type in a \
                  program. Rename one of them.",
    example: " kinds:
   - name: motor
     gates:
       - state: {pub: MotorState, unconnected: ok}
 components:
-  - {name: motor, kind: motor}
+  - {name: main_motor, kind: motor}
 connections: []
",
};

/// SCL1309.
const TOO_MANY: Rule = Rule {
    code: "SCL1309",
    severity: Severity::Error,
    title: "kinds or `everyone` stand for too much",
    explanation: "Together, the components of kinds have at most 100,000 gates, the entries of `everyone` stand for at \
                  most 100,000 gates, and the connections with `each` for at most 100,000 connections. Split the system \
                  into several.",
    example: "",
};

/// Maximum number of gates that components have from kinds, of gates from `everyone`, and of connections that `each`
/// stands for.
pub(crate) const MOST: usize = 100_000;

/// Gives each component of a kind the gates of the kind, and replaces `each` in connections.
pub(crate) fn expand(model: &mut Model, sources: &Sources, problems: &mut Diagnostics) {
    let connections = std::mem::take(&mut model.connections);
    let known = Known::of(model);
    known.report_repeated(problems);
    let meant = unknown::check(&known, &connections, sources, problems);
    known.report_unused(&meant, problems);
    known.report_own_gates(sources, problems);
    let ends = each::replace(&known, connections, sources, problems);
    let kind_of = known.kind_of;
    model.cut_off |= ends.is_cut_off;
    model.connections = ends.connections;
    model.broken_ends.extend(ends.broken);
    let mut gates_left = MOST;
    for (component, kind) in model.components.iter_mut().zip(kind_of) {
        let Some(number) = kind else {
            // The gates of an unknown kind are unknown, unless the component has gates of its own.
            component.gates_unread |= component.kind.is_some() && component.gates_entry.is_none();
            continue;
        };
        let kind = &model.kinds[number];
        let Some(left) = gates_left.checked_sub(kind.gates.len()) else {
            problems.push(too_many(component.name.span, "gates"));
            model.cut_off = true;
            return;
        };
        gates_left = left;
        component.of = Some(number);
        component.gates = kind.gates.clone();
        component.gates_unread = kind.gates_unread;
        component.optional = component.optional.or(kind.optional);
        component.memory = component.memory.take().or_else(|| kind.memory.clone());
        component.doc = component.doc.take().or_else(|| kind.doc.clone());
    }
}

pub(crate) fn too_many(at: Span, what: &str) -> Diagnostic {
    TOO_MANY
        .at(format!("the file stands for more than {MOST} {what}"), at, "here the limit is reached")
        .help("split the system into several")
}

/// The kinds of a file, and the components of each.
struct Known<'m> {
    model: &'m Model,
    /// The names of all kinds, in file order.
    names: Vec<&'m str>,
    /// The numbers of the kinds by their names; of a repeated name, the first.
    kinds: HashMap<&'m str, usize>,
    /// The gates of the kinds.
    gates: HashSet<(usize, &'m str)>,
    /// The kind of each component, if it has one that is known.
    kind_of: Vec<Option<usize>>,
    /// The components of each kind, with their groups.
    components_of: Vec<Vec<(&'m str, usize)>>,
    /// The components by their names.
    components: HashMap<&'m str, &'m ComponentModel>,
    /// The kinds that components name and the file does not declare. They are reported once, there.
    unknown: HashSet<&'m str>,
}

impl<'m> Known<'m> {
    fn of(model: &'m Model) -> Self {
        let kinds = model.kinds.iter().enumerate().rev().map(|(at, kind)| (kind.name.value.as_str(), at));
        let kinds: HashMap<&str, usize> = kinds.collect();
        let kind_of = |component: &ComponentModel| kinds.get(component.kind.as_ref()?.value.as_str()).copied();
        let kind_of: Vec<Option<usize>> = model.components.iter().map(kind_of).collect();
        let mut components_of = vec![Vec::new(); model.kinds.len()];
        let mut components = HashMap::with_capacity(model.components.len());
        for (component, kind) in model.components.iter().zip(&kind_of) {
            let name = component.name.value.as_str();
            if components.insert(name, component).is_none()
                && let Some(kind) = kind
            {
                components_of[*kind].push((name, component.group));
            }
        }
        let names = model.kinds.iter().map(|kind| kind.name.value.as_str()).collect();
        let gates =
            |(at, kind): (usize, &'m ComponentModel)| kind.gates.iter().map(move |gate| (at, gate.name.value.as_str()));
        let gates = model.kinds.iter().enumerate().flat_map(gates).collect();
        let named = model.components.iter().filter_map(|component| Some(component.kind.as_ref()?.value.as_str()));
        let unknown = named.filter(|name| !kinds.contains_key(name)).collect();
        Self { model, names, kinds, gates, kind_of, components_of, components, unknown }
    }

    /// The components of a kind that are in a group.
    fn components_in(&self, kind: usize, group: usize) -> impl Iterator<Item = &'m str> {
        let components = self.components_of[kind].iter().filter(move |(_, of)| self.model.is_within(*of, group));
        components.map(|(name, _)| *name)
    }

    fn report_repeated(&self, problems: &mut Diagnostics) {
        for (at, kind) in self.model.kinds.iter().enumerate() {
            let name = kind.name.value.as_str();
            let first = self.kinds.get(name).map(|first| (*first, &self.model.kinds[*first]));
            if let Some((_, first)) = first.filter(|(first, _)| *first != at) {
                let found =
                    REPEATED.at(format!("kind `{name}` is declared twice"), kind.name.span, "second declaration");
                problems.push(
                    found
                        .label(first.name.span, "first declaration")
                        .help("if they are one kind, remove the second one; otherwise give it another name"),
                );
            } else if let Some(component) = self.components.get(name) {
                let headline = format!("component `{name}` has the name of a kind");
                problems.push(
                    REPEATED
                        .at(headline, component.name.span, "the component")
                        .label(kind.name.span, "the kind")
                        .help("give the component another name, also in its connections"),
                );
            }
        }
    }

    /// Reports kinds without components, except those that the name of an unknown kind may mean.
    fn report_unused(&self, meant: &HashSet<&str>, problems: &mut Diagnostics) {
        if self.model.components_unread {
            return;
        }
        for (kind, components) in self.model.kinds.iter().zip(&self.components_of) {
            let name = &kind.name;
            // A repeated name is reported, and has the components of the first.
            let is_first =
                self.kinds.get(name.value.as_str()).is_some_and(|at| std::ptr::eq(&self.model.kinds[*at], kind));
            if components.is_empty() && is_first && !meant.contains(name.value.as_str()) {
                let headline = format!("no component is of kind `{}`", name.value);
                problems.push(UNUSED.at(headline, name.span, "has no effect").help(format!(
                    "a component of the kind is an item of `components`: `- {{name: {}_1, kind: {}}}`",
                    name.value, name.value
                )));
            }
        }
    }

    fn report_own_gates(&self, sources: &Sources, problems: &mut Diagnostics) {
        for (component, kind) in self.model.components.iter().zip(&self.kind_of) {
            let (Some(kind), Some(gates)) = (kind, component.gates_entry) else { continue };
            let kind = &self.model.kinds[*kind];
            let (name, of) = (&component.name.value, &kind.name.value);
            let key = Span { end: gates.start + "gates".len() as u32, ..gates };
            let found = OWN_GATES
                .at(format!("component `{name}` is of kind `{of}` and has gates of its own"), key, "")
                .label(kind.name.span, "all components of the kind have its gates");
            // Other gates than none may be needed.
            let found = match (component.gates.is_empty(), removal(sources.file(gates.file), gates)) {
                (true, Some(removed)) => found.propose("remove `gates`", [removed]),
                (false, Some(removed)) => found.suggest("remove them, if the gates of the kind are meant", [removed]),
                (_, None) => found.help("remove them, if the gates of the kind are meant"),
            };
            problems.push(match &component.kind {
                Some(kind) if !component.gates.is_empty() => {
                    let text = format!("or add them to the kind `{of}`, or remove `kind: {of}`");
                    found.suggest_removal(text, sources.file(kind.span.file), entry(kind, sources))
                }
                _ => found,
            });
        }
    }
}

/// The entry `kind: motor` of a component.
fn entry(kind: &Spanned<String>, sources: &Sources) -> Span {
    let before = &sources.file(kind.span.file).text()[..kind.span.start as usize];
    let start = before.rfind(KIND).map_or(kind.span.start, |start| start as u32);
    Span { start, ..kind.span }
}
