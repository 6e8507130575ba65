//! A component that is declared twice, perhaps under two spellings of its name: one declaration may be a copy that was
//! left over.

use crate::diagnostic::{Diagnostic, Edit, removal};
use crate::model::{ComponentModel, ConnectionModel, GateModel, Model};
use crate::source::Sources;
use scl_text::gate_name::split;
use std::collections::{HashMap, HashSet};

/// Maximum length of the text between two declarations that is searched, in bytes.
const MOST_BETWEEN: usize = 4_096;

/// Suggests to remove the second component, or the first, if the other one has all its gates.
pub(super) fn suggest(
    found: Diagnostic,
    model: &Model,
    sources: &Sources,
    [first, second]: [&ComponentModel; 2],
) -> Diagnostic {
    let between = first.span.end.min(second.span.end) as usize..first.span.start.max(second.span.start) as usize;
    let file = Some(sources.file(first.span.file)).filter(|_| first.span.file == second.span.file);
    let between = file.and_then(|file| file.text().get(between)).filter(|text| text.len() < MOST_BETWEEN);
    let is_condition = |line: &str| ["#if", "#else", "#elif"].iter().any(|word| line.trim_start().starts_with(word));
    let found = match between.and_then(|text| text.lines().find(|line| is_condition(line))) {
        Some(line) => found
            .help("keep one of the two; the programs of a component are chosen in the launch file, by `profiles`")
            .note(format!("`{}` is a comment in YAML: both declarations are read", line.trim())),
        None => found,
    };
    let ways = [[first, second], [second, first]];
    let Some((copy, edits)) =
        ways.into_iter().find_map(|[kept, copy]| Some((copy, merged(model, sources, kept, copy)?)))
    else {
        return found;
    };
    let what = match first.name.value == second.name.value {
        true if std::ptr::eq(copy, second) => "the second one; otherwise give it another name".to_owned(),
        true => "the first one; otherwise give it another name".to_owned(),
        false if edits.len() > 1 => format!("`{}` and its connections", copy.name.value),
        false => format!("`{}`", copy.name.value),
    };
    found.suggest(format!("if they are one component, remove {what}"), edits)
}

/// The changes that remove `copy`, with those of its connections that `kept` has, and give the others to `kept`. `None`
/// if it has a gate that `kept` does not have.
fn merged(model: &Model, sources: &Sources, kept: &ComponentModel, copy: &ComponentModel) -> Option<Vec<Edit>> {
    let gates: HashMap<&str, &GateModel> = kept.gates.iter().map(|gate| (gate.name.value.as_str(), gate)).collect();
    let has = |gate: &GateModel| gates.get(gate.name.value.as_str()).is_some_and(|twin| is_alike(twin, gate));
    let is_empty = copy.gates.is_empty() && kept.name.value != copy.name.value;
    if is_empty || kept.gates_unread || copy.gates_unread || !copy.gates.iter().all(has) {
        return None;
    }
    let mut edits = vec![removal(sources.file(copy.span.file), copy.span)?];
    if kept.name.value == copy.name.value {
        return Some(edits);
    }
    let pairs: HashSet<[&str; 2]> = model.connections.iter().map(ends).collect();
    for connection in &model.connections {
        let renamed = ends(connection).map(|end| {
            let gate = split(end).filter(|(of, _)| *of == copy.name.value).map(|(_, gate)| gate)?;
            Some(format!("{}.{gate}", kept.name.value))
        });
        if renamed.iter().all(Option::is_none) {
            continue;
        }
        let [a, b] = [0, 1].map(|at| renamed[at].as_deref().unwrap_or(ends(connection)[at]));
        if pairs.contains(&[a, b]) || pairs.contains(&[b, a]) {
            edits.push(removal(sources.file(connection.span.file), connection.span)?);
            continue;
        }
        let changed = connection.ends.iter().zip(renamed.iter());
        edits.extend(
            changed.filter_map(|(end, name)| Some(Edit::new(end.span, sources.quoted_as(end.span, name.as_deref()?)))),
        );
    }
    Some(edits)
}

fn ends(connection: &ConnectionModel) -> [&str; 2] {
    connection.ends.each_ref().map(|end| end.value.as_str())
}

/// Whether two gates of one name have one kind, and one type as far as both have one.
pub(super) fn is_alike(one: &GateModel, other: &GateModel) -> bool {
    let types = [one, other].map(|gate| gate.payload.as_ref().map(|payload| payload.value.trim()));
    one.kind.value == other.kind.value && types[0].zip(types[1]).is_none_or(|(one, other)| one == other)
}
