//! `scl simulate --twice`: whether two simulations do the same, and what differs first.

use scl_record::compare::{CompareOptions, CompareReport, Difference, DifferenceKind, compare};
use scl_record::recording::{Recording, find_files};
use scl_terminal::{Problem, escape};
use std::path::Path;
use std::time::Duration;

/// Compares the recordings of two simulations. Returns `None` if they are equal to the last bit.
///
/// # Errors
/// If a recording cannot be read.
pub(super) fn difference(first: &Path, second: &Path) -> Result<Option<Problem>, Problem> {
    let read = |path: &Path| {
        let cannot = |error| Problem::new(format!("cannot read `{}`: {error}", path.display()));
        std::fs::read(path).map_err(cannot)
    };
    if read(first)? == read(second)? {
        return Ok(None);
    }
    let open = |path: &Path| Recording::open(&find_files(&[path.to_owned()])?);
    let options = CompareOptions { times_within: Some(Duration::ZERO), shown: 1, ..CompareOptions::default() };
    let report = compare(&open(first)?, &open(second)?, &options, &|_| {})?;
    let text = first_of(&report).unwrap_or_else(|| "in the order of messages of different gates".to_owned());
    let problem = Problem::new(format!("two simulations with the same seed differ, first {text}"));
    Ok(Some(problem.help(
        "a program depends on something outside the simulation, such as a file that it changes, its process id, or the \
         network: see docs/simulate.md",
    )))
}

/// Describes the first difference.
fn first_of(report: &CompareReport) -> Option<String> {
    let all = report.gates.iter().filter_map(|gate| Some((gate.name.as_str(), gate.differences.first()?)));
    let (gate, difference) = all.min_by_key(|(_, difference)| difference.time)?;
    let (time, number) = (difference.time.as_secs_f64(), difference.index + 1);
    Some(format!("{time:.6} s after the first message, at `{gate}`: message {number} {}", what(difference)))
}

fn what(difference: &Difference) -> String {
    let [first, second] = &difference.values;
    match (difference.kind, first, second) {
        (DifferenceKind::Missing, ..) => "is missing in the second one".to_owned(),
        (DifferenceKind::Additional, ..) => "is missing in the first one".to_owned(),
        (DifferenceKind::Different, first, second) => {
            let shown = |value: &Option<String>| value.as_deref().map_or("nothing".into(), escape).into_owned();
            let field = if difference.field == "." { "" } else { &difference.field };
            format!("has {} and then {} in `{}`", shown(first), shown(second), escape(field))
        }
    }
}
