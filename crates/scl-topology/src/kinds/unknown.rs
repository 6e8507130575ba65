//! SCL1301: a component of a kind that is not declared.

use super::{Known, each_end, entry};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity, removal};
use crate::model::Model;
use crate::source::{Sources, Span, Spanned};
use crate::suggest::similar;
use scl_text::list::listed;
use std::collections::{HashMap, HashSet};

/// SCL1301.
pub(super) const RULE: Rule = Rule {
    code: "SCL1301",
    severity: Severity::Error,
    title: "unknown kind",
    explanation: "A component is of a kind that the section `kinds` does not declare, so its gates are not known. The \
                  name is probably misspelt; declare the kind, or correct the name.",
    example: " kinds:
   - name: motor
     gates:
       - state: {pub: MotorState, unconnected: ok}
 components:
   - {name: left_motor, kind: motor}
-  - {name: right_motor, kind: moter}
+  - {name: right_motor, kind: motor}
 connections: []
",
};

/// Maximum number of unknown kinds that are compared with all others.
const MOST_SEARCHES: usize = 20;

/// Reports unknown kinds, each at its components, and returns the kinds that their names may mean.
pub(super) fn check<'m>(known: &Known<'m>, sources: &Sources, problems: &mut Diagnostics) -> HashSet<&'m str> {
    if known.model.kinds_unread {
        return HashSet::new();
    }
    let mut meant: HashMap<&str, Vec<&str>> = HashMap::new();
    for component in &known.model.components {
        let kind = component.kind.as_ref().filter(|kind| known.unknown.contains(kind.value.as_str()));
        let Some(kind) = kind else { continue };
        let name = kind.value.as_str();
        let (searches, is_first) = (meant.len(), !meant.contains_key(name));
        let near =
            meant.entry(name).or_insert_with(|| if searches < MOST_SEARCHES { near(known, name) } else { vec![] });
        let found = RULE.at(format!("unknown kind `{name}`"), kind.span, "no kind has this name");
        let found = propose(found, known, near, kind, is_first, sources);
        let without = component.gates_entry.and_then(|_| removal(sources.file(kind.span.file), entry(kind, sources)));
        let found = match without {
            Some(removed) if near.is_empty() => {
                found.propose("remove it: the component has gates of its own", [removed])
            }
            _ => found,
        };
        let found = found.otherwise("a kind is declared in the section `kinds`, with its gates");
        let found = match known.names.is_empty() {
            true => found,
            false => found.note(format!("declared kinds: {}", listed(&known.names))),
        };
        problems.push(found.about(name));
    }
    meant.into_values().flatten().collect()
}

/// Similar kinds, or the only one of them that has no components.
fn near<'m>(known: &Known<'m>, name: &str) -> Vec<&'m str> {
    let near = similar(name, known.names.iter().copied());
    let mut unused = near.iter().copied().filter(|name| is_unused(known, name));
    match (unused.next(), unused.next()) {
        (Some(only), None) => vec![only],
        _ => near,
    }
}

fn is_unused(known: &Known<'_>, name: &str) -> bool {
    known.kinds.get(name).is_some_and(|kind| known.components_of[*kind].is_empty())
}

/// Proposes the kinds that a name may mean. The proposals for all components become one, so that the first one adds
/// what is changed once.
fn propose(
    found: Diagnostic,
    known: &Known<'_>,
    near: &[&str],
    kind: &Spanned<String>,
    is_first: bool,
    sources: &Sources,
) -> Diagnostic {
    let edit = |(at, text): (Span, String)| Edit::new(at, sources.quoted_as(at, &text));
    let ends = if is_first && !near.is_empty() { each_of(known.model, &kind.value) } else { Vec::new() };
    let named = |near: &str| {
        let ends = ends.iter().map(|(end, gate)| (*end, each_end(near, gate)));
        ends.chain([(kind.span, near.to_owned())]).map(edit).collect()
    };
    let found = found.choose_all(("did you mean ", "?"), near.iter().map(|near| (*near, named(near))));
    match near {
        // The declaration may be misspelt.
        [only] if is_first && is_unused(known, only) => {
            let declared = known.model.kinds[known.kinds[only]].name.span;
            found
                .label(declared, "a similar kind is declared here")
                .suggest(format!("or rename the kind to `{}`", kind.value), [edit((declared, kind.value.clone()))])
        }
        _ => found,
    }
}

/// The ends of connections with `each` of a kind, with their gates.
fn each_of<'m>(model: &'m Model, kind: &str) -> Vec<(Span, &'m str)> {
    let ends = model.connections.iter().flat_map(|connection| &connection.ends);
    let of_kind = ends.filter_map(|end| {
        let (name, gate) = super::each_of(&end.value)?.split_once('.')?;
        (name == kind).then_some((end.span, gate))
    });
    of_kind.collect()
}
