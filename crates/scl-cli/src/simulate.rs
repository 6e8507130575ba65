//! `scl simulate`: runs a system in simulated time.
//!
//! Each simulation is a process of its own (`here`), whose runtime folder no other uses; this one starts it
//! (`process`), or several of them, and looks at what they report (`report`): whether two do the same (`twice`), or
//! which seeds fail (`seeds`).

mod here;
mod process;
mod report;
mod seeds;
mod shrink;
mod twice;

pub(crate) use here::{HereArguments, simulate_here};
pub(crate) use process::RUN_WORD;

use crate::run::ProgramArguments;
use clap::Args;
use process::Process;
use scl_terminal::{Problem, parse_duration, print_err};
use std::num::NonZero;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

/// Run a system in simulated time: the same way each time, and faster than real time.
///
/// Starts the programs of the launch file as `scl run` does, unchanged and over their usual sockets. Time stands still
/// while a program works, and passes at once when all wait. A program sees only this time, in Rust, C, C++ and Python.
///
/// The system runs in a folder of its own, beside one that runs in real time.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl simulate                           the system in the working folder, until its programs end
  scl simulate examples/rover --until 1h an hour, in seconds
  scl simulate --seed 7                  with other random numbers
  scl simulate --speed 1                 in real time, to watch it
  scl simulate --replay flight.mcap --as sensor -o new.mcap
  scl simulate --scenario rough.yaml     with faults, and with what must hold all the same
  scl simulate --scenario rough.yaml --seeds 1..500 --jobs 2

Two simulations with the same programs, files, arguments and seed do the same. docs/simulate.md says what a program must
not do for that, and which programs cannot take part.

Exit code: 0 all ended cleanly or were stopped, 1 a component failed or had to be killed, something expected did not
happen, or two simulations differ, 2 nothing could be started, or the simulation could not go on.")]
pub(crate) struct SimulateArguments {
    #[command(flatten)]
    programs: ProgramArguments,
    /// Stop after this time of the simulation, for example `2min`, and succeed.
    #[arg(long, value_name = "TIME", value_parser = parse_duration)]
    until: Option<Duration>,
    /// Where random numbers of all programs come from.
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    seed: u64,
    /// Record the messages of all gates into this file, which must not exist.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Play components from this recording in place of their programs.
    #[arg(long, value_name = "FILE", requires = "played")]
    replay: Option<PathBuf>,
    /// The components that are played.
    #[arg(long = "as", id = "played", value_name = "COMPONENT,...", value_delimiter = ',', requires = "replay")]
    played: Vec<String>,
    /// Simulate twice, and say what differs first if anything does.
    #[arg(long)]
    twice: bool,
    /// Let happen what this file says, and check what it expects.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Of the faults of the scenario, let only those with these numbers happen; `none`: no faults.
    #[arg(long, value_name = "N,...", value_parser = ChosenFaults::parse, requires = "scenario")]
    faults: Option<ChosenFaults>,
    /// Simulate with each of these seeds, for example `1..500`, and list those that fail.
    #[arg(long, value_name = "FIRST..LAST", value_parser = parse_seeds)]
    #[arg(conflicts_with_all = ["seed", "twice", "output", "faults"])]
    seeds: Option<RangeInclusive<u64>>,
    /// How many simulations run at the same time, each on a processor of its own.
    #[arg(long, value_name = "N", default_value = "1", requires = "seeds")]
    jobs: NonZero<usize>,
    /// Let time pass no faster than this many times real time.
    #[arg(long, value_name = "FACTOR", value_parser = parse_speed)]
    speed: Option<f64>,
    /// How long a program may run without waiting, in real time.
    #[arg(long, value_name = "TIME", default_value = "30s", value_parser = parse_duration)]
    patience: Duration,
    /// How many turns programs may have before time passes.
    #[arg(long, value_name = "N", default_value_t = 1_000_000)]
    most_turns: u64,
}

/// Which faults of a scenario happen, by their numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ChosenFaults(Vec<usize>);

impl ChosenFaults {
    fn parse(text: &str) -> Result<Self, String> {
        let numbers = if text == "none" { Vec::new() } else { text.split(',').collect() };
        let numbers: Result<_, _> = numbers.iter().map(|number| number.trim().parse()).collect();
        numbers.map(Self).map_err(|_| "expected numbers of faults such as `2,5`, or `none`".to_owned())
    }

    fn text(&self) -> String {
        let numbers: Vec<String> = self.0.iter().map(usize::to_string).collect();
        if numbers.is_empty() { "none".to_owned() } else { numbers.join(",") }
    }
}

fn parse_speed(text: &str) -> Result<f64, String> {
    let speed = text.parse().ok().filter(|speed: &f64| speed.is_finite() && *speed > 0.0);
    speed.ok_or_else(|| "expected a number above 0, for example `1` or `0.5`".to_owned())
}

fn parse_seeds(text: &str) -> Result<RangeInclusive<u64>, String> {
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    match (first.parse(), last.parse()) {
        (Ok(first), Ok(last)) if first <= last => Ok(first..=last),
        _ => Err("expected the first and the last seed, for example `1..500`".to_owned()),
    }
}

/// The body of `scl simulate`.
pub(crate) fn simulate(arguments: &SimulateArguments) -> Result<ExitCode, Problem> {
    if let Some(output) = arguments.output.as_ref().filter(|output| output.exists()) {
        let problem = Problem::new(format!("`{}` exists already", output.display()));
        return Err(problem.help("delete it, or choose another name"));
    }
    match &arguments.seeds {
        Some(seeds) => seeds::simulate_seeds(seeds.clone(), arguments),
        None if arguments.twice => simulate_twice(arguments),
        None => Process { output: arguments.output.as_deref(), ..Process::default() }.run(),
    }
}

/// Runs a simulation that is recorded, and a second one. The exit code is that of the first if both do the same.
fn simulate_twice(arguments: &SimulateArguments) -> Result<ExitCode, Problem> {
    let folder = process::folder()?;
    let first = arguments.output.clone().unwrap_or_else(|| folder.path().join("first.mcap"));
    let second = folder.path().join("second.mcap");
    let code = Process { output: Some(&first), ..Process::default() }.run()?;
    if !first.exists() {
        return Ok(code);
    }
    // Its programs were built for the first one.
    Process { output: Some(&second), is_built: true, ..Process::default() }.run()?;
    match twice::difference(&first, &second)? {
        None => {
            print_err("scl: both simulations did the same\n");
            Ok(code)
        }
        Some(problem) => {
            print_err(&problem.to_string());
            Ok(ExitCode::FAILURE)
        }
    }
}
