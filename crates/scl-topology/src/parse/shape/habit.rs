//! What to write for a key of another tool.

use super::option_value::replacement;
use crate::diagnostic::{Diagnostic, Edit};
use crate::grammar::{self, GateOption, Shape};
use crate::habits::{self, Habit, Table};
use crate::parse::field::Field;
use crate::parse::meant::meant;
use crate::source::{SourceFile, Span};
use crate::yaml::NodeKind;

/// Longest value that a text repeats.
const SHOWN: usize = 40;

/// Adds the key that a word is in another spelling, such as `whenFull`; returns false in the second place if it is
/// none.
pub(super) fn with_spelling(
    problem: Diagnostic,
    field: Field<'_>,
    keys: impl IntoIterator<Item = &'static str>,
) -> (Diagnostic, bool) {
    let word = habits::compact(field.key);
    match keys.into_iter().find(|key| *key != field.key && habits::compact(key) == word) {
        Some(key) => (problem.propose(format!("the key is written `{key}`"), [Edit::new(field.key_span, key)]), true),
        None => (problem, false),
    }
}

/// Adds what to write for a word of another tool: the key that it is called here, with its value. `takes` returns false
/// for keys that do not belong at this place.
pub(super) fn with_habit(
    problem: Diagnostic,
    habit: &Habit,
    field: Field<'_>,
    takes: impl Fn(&str) -> bool,
) -> Diagnostic {
    let ways: Vec<(&str, Option<&str>)> =
        habit.ways.iter().map(|way| split(way)).filter(|(key, _)| takes(key)).collect();
    let problem =
        ways.iter().fold(problem, |problem, &(key, value)| with_way(problem, field, key, value, ways.len() == 1));
    match (habit.text, ways.first()) {
        ("", Some((key, _))) => problem.otherwise(called(key)),
        ("", None) => problem,
        (text, Some(_)) => problem.otherwise(text),
        (text, None) => problem.help(text),
    }
}

pub(super) fn split(way: &'static str) -> (&'static str, Option<&'static str>) {
    way.split_once(": ").map_or((way, None), |(key, value)| (key, Some(value)))
}

fn called(key: &str) -> String {
    let values = shape(key).map(Shape::values).filter(|_| grammar::option(key).is_some());
    let values = values.map(|values| format!("; allowed: {values}"));
    format!("it is called `{key}` here{}", values.unwrap_or_default())
}

fn with_way(problem: Diagnostic, field: Field<'_>, key: &str, value: Option<&str>, is_only: bool) -> Diagnostic {
    let written = field.value.text();
    let new = match value {
        Some("!") => match written.and_then(habits::boolean) {
            Some(word) => Some(if word == "true" { "false" } else { "true" }.to_owned()),
            None => return problem,
        },
        Some(value) => Some(value.to_owned()),
        None => converted(key, field),
    };
    // A number that several keys could have is not one with a unit.
    let is_number = written.is_some_and(grammar::is_whole_number);
    if !is_only && is_number && new.is_some() {
        return problem;
    }
    let renamed = Edit::new(field.key_span, key);
    let text = match new.as_deref().or(written).filter(|value| value.len() <= SHOWN) {
        Some(value) => format!("it is written `{key}: {value}` here"),
        None => format!("it is called `{key}` here"),
    };
    match new {
        Some(value) => problem.suggest(text, [renamed, replacement(field, &value)]),
        None if is_only => problem.propose(text, [renamed]),
        None => problem.suggest(text, [renamed]),
    }
}

/// The value in the form that another key expects; none if it has this form.
pub(super) fn converted(key: &str, field: Field<'_>) -> Option<String> {
    let shape = shape(key)?;
    if field.value.text().is_some_and(|text| shape.fits(text, field.value.is_plain())) {
        return None;
    }
    let values = meant(key, field.value, shape).values;
    // `timeout_ms: 50`.
    let unit = field.key.to_lowercase().ends_with("ms").then(|| values.iter().find(|value| value.ends_with("ms")));
    unit.flatten().or(values.first()).cloned()
}

/// Whether a key could have the value of a field, perhaps in another form.
pub(super) fn could_have(key: &str, field: Field<'_>) -> bool {
    let fits = |shape: Shape| field.value.text().is_some_and(|text| shape.fits(text, field.value.is_plain()));
    shape(key).is_some_and(fits) || converted(key, field).is_some()
}

fn shape(key: &str) -> Option<Shape> {
    let keys = grammar::SECTIONS.iter().chain(&grammar::COMPONENT_KEYS);
    let option = || keys.clone().find(|known| known.key == key).map(|known| known.shape);
    grammar::option(key).map(|option| option.shape).or_else(option)
}

/// `with: {queue: 4}`: adds the proposal to write the entries in the place of the key that they are below.
pub(super) fn with_lifted(
    problem: Diagnostic,
    field: Field<'_>,
    table: &'static Table,
    is_known: impl Fn(&str) -> bool,
    source: &SourceFile,
) -> Diagnostic {
    let NodeKind::Mapping { entries } = &field.value.kind else { return problem };
    let whole = field.key_span.to(field.value.span);
    let line = source.line_range(field.key_span.start as usize).start as u32;
    let head = source.snippet(Span { start: line, end: field.key_span.start, ..whole });
    let mut lifted: Vec<String> = Vec::new();
    for (key_node, value) in entries {
        let Some(word) = key_node.text() else { return problem };
        let habit = table.find(word).and_then(|habit| habit.ways.first()).map(|way| split(way).0);
        let Some(known) = Some(word).filter(|word| is_known(word)).or(habit) else { return problem };
        let entry = Field { key: word, key_span: key_node.span, key_node, value };
        let value = converted(known, entry).unwrap_or_else(|| source.snippet(value.span).to_owned());
        if value.contains('\n') {
            return problem;
        }
        let entry = format!("{known}: {value}");
        // A value that is the default may be left out.
        let is_default = grammar::option(known).and_then(GateOption::default).is_some_and(|default| default == value);
        if !is_default && !lifted.contains(&entry) {
            lifted.push(entry);
        }
    }
    if lifted.is_empty() || source.snippet(whole).contains('#') {
        return problem;
    }
    let separator = match head.trim_start_matches([' ', '-']).is_empty() {
        true => format!("\n{}", " ".repeat(head.len())),
        false => ", ".to_owned(),
    };
    let text = match lifted.as_slice() {
        [only] => format!("write `{only}` in its place"),
        _ => format!("write the keys of `{}` in its place", field.key),
    };
    problem.suggest(text, [Edit::new(whole, lifted.join(&separator))])
}
