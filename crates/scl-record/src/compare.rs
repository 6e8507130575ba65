//! Comparing two recordings: the same messages in the same order, gate by gate.
//!
//! Times are compared only on request, so a recording can be compared with a recording of its replay at another rate. A
//! message that only one recording has is found by the messages that follow it, so one lost message is one difference.

mod align;
mod report;
mod side;
mod values;

pub use report::{CompareReport, Difference, DifferenceKind, GateComparison};

use crate::format::Topic;
use crate::recording::{Recording, Survey};
use align::Alignment;
use scl_terminal::{Problem, escape, quoted_list};
use scl_value::FieldPath;
use side::{Side, check_types};
use std::collections::BTreeSet;
use std::time::Duration;
use values::Rules;

/// Which gates and fields are compared, and with which tolerances.
#[derive(Debug, Clone, Default)]
pub struct CompareOptions {
    /// Compare these gates only; empty: all.
    pub gates: Vec<String>,
    /// Compare these fields only; empty: all.
    pub fields: Vec<FieldPath>,
    /// Absolute tolerance for numbers.
    pub within: f64,
    /// Tolerance for numbers as a fraction of the larger one: 0.01 is one percent. The greater tolerance applies.
    pub relative: f64,
    /// How much the send times of two paired messages may differ, each counted from the first pair of their topic;
    /// `None`: times are not compared.
    pub times_within: Option<Duration>,
    /// Maximum number of differences kept for each topic.
    pub shown: usize,
}

/// Compares two recordings. Calls `progress` with the position in the first one.
///
/// # Errors
/// A recording cannot be read; neither has messages of a named gate, or the types of a gate differ; no compared message
/// has a named field; there are no messages to compare.
pub fn compare(
    first: &Recording,
    second: &Recording,
    options: &CompareOptions,
    progress: &dyn Fn(Duration),
) -> Result<CompareReport, Problem> {
    let surveys = [first.survey()?, second.survey()?];
    let names = [first.name(), second.name()];
    let topics = choose_topics(&surveys, options)?;
    check_types(names.each_ref().map(String::as_str), &surveys, &topics)?;
    let mut sides = [Side::new(first, &surveys[0], &topics), Side::new(second, &surveys[1], &topics)];
    let mut rules = Rules::new(options);
    let mut alignments: Vec<_> = topics.iter().map(|topic| Alignment::new(topic, options)).collect();
    // Read from the side that has less in memory, so that both advance together.
    let queued = |side: &&mut Side| side.topics.iter().map(|topic| topic.bytes).sum::<usize>();
    while let Some(side) = sides.iter_mut().filter(|side| !side.is_at_end).min_by_key(queued) {
        if let Some(index) = side.read()? {
            alignments[index].advance(&mut sides, index, &mut rules);
        }
        progress(sides[0].position);
    }
    rules.check_fields()?;
    let notes = |(name, survey): (&String, &Survey)| {
        survey.notes().into_iter().map(|note| format!("`{name}`: {note}")).collect::<Vec<_>>()
    };
    let notes: Vec<_> = names.iter().zip(&surveys).flat_map(notes).collect();
    let gates: Vec<_> = alignments.into_iter().map(Alignment::finish).collect();
    if gates.iter().all(|gate| gate.messages() == 0) {
        let message = format!("there is nothing to compare: no messages in `{}` and `{}`", names[0], names[1]);
        return Err(notes.into_iter().fold(Problem::new(message), Problem::note));
    }
    Ok(CompareReport { gates, notes })
}

/// Returns the topics to compare: those of the named gates, or all.
fn choose_topics(surveys: &[Survey; 2], options: &CompareOptions) -> Result<Vec<Topic>, Problem> {
    let all: BTreeSet<&Topic> = surveys.iter().flat_map(|survey| survey.topics.keys()).collect();
    let names: BTreeSet<String> = all.iter().map(|topic| topic.gate_name()).collect();
    if let Some(gate) = options.gates.iter().find(|gate| !names.contains(*gate)) {
        let problem = Problem::new(format!("neither recording has messages of a gate `{}`", escape(gate)));
        return Err(problem.did_you_mean_or(gate, names.iter().map(String::as_str), |problem| {
            match names.is_empty() {
                true => problem.help("record the gate, or compare other recordings"),
                false => problem.note(format!("gates: {}", quoted_list(&names))),
            }
        }));
    }
    let is_chosen = |topic: &&Topic| options.gates.is_empty() || options.gates.contains(&topic.gate_name());
    Ok(all.into_iter().filter(is_chosen).cloned().collect())
}

#[cfg(test)]
mod tests;
