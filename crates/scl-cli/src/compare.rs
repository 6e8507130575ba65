//! `scl compare`: whether two recordings have the same messages.

use crate::format::FormatArgument;
use clap::Args;
use scl_record::compare::{CompareOptions, compare as compare_recordings};
use scl_record::progress::Progress;
use scl_record::recording::{Recording, find_files};
use scl_terminal::{Problem, parse_duration, print_err};
use scl_value::FieldPath;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

/// Compare two recordings gate by gate: the same messages in the same order.
///
/// Numbers may differ by a tolerance, everything else must be equal. Times are compared only with `--times-within`. A
/// message that is missing or additional is one difference, also when others follow it.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl compare flight.mcap new.mcap                            all gates
  scl compare flight.mcap new.mcap --gate controller.actuator --within 1e-6
  scl compare flight.mcap new.mcap --field throttle --relative 0.01
  scl compare flight.mcap new.mcap --times-within 5ms

Exit code: 0 equal, 1 different, 2 could not compare.")]
pub(crate) struct CompareArguments {
    /// The first recording; a pattern in quotes (`'a_*.mcap'`) or the common name of its parts, if it was split.
    #[arg(value_name = "A")]
    first: PathBuf,
    /// The second recording.
    #[arg(value_name = "B")]
    second: PathBuf,
    /// Compare these gates only; of a `rep` gate, its requests and its replies.
    #[arg(long, value_name = "GATE,...", value_delimiter = ',')]
    gate: Vec<String>,
    /// Compare these fields only, for example `pose.x`.
    #[arg(long, value_name = "FIELD,...", value_delimiter = ',')]
    field: Vec<FieldPath>,
    /// How much numbers may differ.
    #[arg(long, value_name = "NUMBER", default_value = "0", value_parser = parse_tolerance, allow_negative_numbers = true)]
    within: f64,
    /// How much numbers may differ, as a part of the larger one: 0.01 is one percent.
    #[arg(long, value_name = "NUMBER", default_value = "0", value_parser = parse_tolerance, allow_negative_numbers = true)]
    relative: f64,
    /// How much the times of messages may differ, counted from the first of each gate.
    #[arg(long, value_name = "TIME", value_parser = parse_duration)]
    times_within: Option<Duration>,
    /// How many differences to show for each gate.
    #[arg(long, value_name = "N", default_value = "10")]
    show: usize,
    #[command(flatten)]
    format: FormatArgument,
}

/// The body of `scl compare`.
pub(crate) fn compare(arguments: &CompareArguments) -> Result<ExitCode, Problem> {
    let (first, second) = (open(&arguments.first)?, open(&arguments.second)?);
    let options = CompareOptions {
        gates: arguments.gate.clone(),
        fields: arguments.field.clone(),
        within: arguments.within,
        relative: arguments.relative,
        times_within: arguments.times_within,
        shown: arguments.show,
    };
    let progress = Progress::new("comparing", first.duration());
    let report = compare_recordings(&first, &second, &options, &|position| progress.set(position))?;
    drop(progress);
    report.notes.iter().for_each(|note| print_err(&format!("note: {note}\n")));
    arguments.format.print(|| report.to_json(), || report.to_text());
    Ok(if report.is_equal() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn open(path: &Path) -> Result<Recording, Problem> {
    let recording = Recording::open(&find_files(&[path.to_owned()])?)?;
    recording.notes().iter().for_each(|note| print_err(&format!("note: {note}\n")));
    Ok(recording)
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number >= 0.0);
    number.ok_or_else(|| "expected a number of at least 0, like `1e-6`".to_owned())
}
