//! SCL1301: a component of a kind that is not declared.

use super::{Known, each_end, entry};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity, removal};
use crate::model::ConnectionModel;
use crate::source::{Sources, Span, Spanned};
use crate::suggest::Searches;
use scl_text::gate_name::split;
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

/// Reports unknown kinds, each at its components, and returns the kinds that their names may mean.
pub(super) fn check<'m>(
    known: &Known<'m>,
    connections: &[ConnectionModel],
    sources: &Sources,
    problems: &mut Diagnostics,
) -> HashSet<&'m str> {
    if known.model.kinds_unread {
        return HashSet::new();
    }
    let mut searches = Searches::default();
    let mut meant: HashMap<&str, Vec<&str>> = HashMap::new();
    for component in &known.model.components {
        let kind = component.kind.as_ref().filter(|kind| known.unknown.contains(kind.value.as_str()));
        let Some(kind) = kind else { continue };
        let name = kind.value.as_str();
        let is_first = !meant.contains_key(name);
        let near = meant.entry(name).or_insert_with(|| near(known, name, &mut searches));
        let found = RULE.at(format!("unknown kind `{name}`"), kind.span, "no kind has this name");
        // The proposals for all components become one: the first adds what is changed once.
        let ends = (is_first && !near.is_empty()).then(|| each_of(connections, name));
        let found = propose(found, known, near, kind, ends, sources);
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
fn near<'m>(known: &Known<'m>, name: &str, searches: &mut Searches) -> Vec<&'m str> {
    let near = searches.similar(name, known.names.iter().copied());
    let mut unused = near.iter().copied().filter(|name| is_unused(known, name));
    match (unused.next(), unused.next()) {
        (Some(only), None) => vec![only],
        _ => near,
    }
}

fn is_unused(known: &Known<'_>, name: &str) -> bool {
    known.kinds.get(name).is_some_and(|kind| known.components_of[*kind].is_empty())
}

/// Proposes the kinds that a name may mean; `ends` are those of connections that are changed, too.
fn propose(
    found: Diagnostic,
    known: &Known<'_>,
    near: &[&str],
    kind: &Spanned<String>,
    ends: Option<Vec<(Span, &str)>>,
    sources: &Sources,
) -> Diagnostic {
    let edit = |(at, text): (Span, String)| Edit::new(at, sources.quoted_as(at, &text));
    let named = |near: &str| {
        let ends = ends.iter().flatten().map(|(end, gate)| (*end, each_end(near, gate)));
        ends.chain([(kind.span, near.to_owned())]).map(edit).collect()
    };
    let found = found.choose_all(("did you mean ", "?"), near.iter().map(|near| (*near, named(near))));
    match near {
        // The declaration may be misspelt.
        [only] if ends.is_some() && is_unused(known, only) => {
            let declared = known.model.kinds[known.kinds[only]].name.span;
            found
                .label(declared, "a similar kind is declared here")
                .suggest(format!("or rename the kind to `{}`", kind.value), [edit((declared, kind.value.clone()))])
        }
        _ => found,
    }
}

/// The ends of connections with `each` of a kind, with their gates.
fn each_of<'m>(connections: &'m [ConnectionModel], kind: &str) -> Vec<(Span, &'m str)> {
    let ends = connections.iter().flat_map(|connection| &connection.ends);
    let of_kind = ends.filter_map(|end| {
        let (name, gate) = split(super::each_of(&end.value)?)?;
        (name == kind).then_some((end.span, gate))
    });
    of_kind.collect()
}
