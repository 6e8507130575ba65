//! `scl run`: starts the program of every component, shows what they print, and stops them together.

mod cargo_package;
mod children;
mod ending;
mod launch_file;
mod launch_text;
mod orphan_guard;
mod output;
mod plan;
mod problem;
mod program;
mod reports;
mod supervisor;

pub(crate) use orphan_guard::{GUARD_WORD, START_WORD, StartArguments, keep_watch, start_component, stop_signals};

use crate::duration::parse_duration;
use crate::print::print_err;
use children::{Event, Running};
use clap::Args;
use orphan_guard::OrphanGuard;
use output::Output;
use problem::Problem;
use program::Program;
use reports::Reports;
use std::io;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::thread;
use std::time::Duration;
use supervisor::{Limits, Supervisor};

/// Exit code: nothing could be started.
const COULD_NOT_RUN: u8 = 2;

/// Starts every component of a system and shows what they print.
///
/// Reads `launch.yaml` in FOLDER, which says how each component is started. Without one, builds the cargo package in
/// FOLDER and starts the program named like each component of `topology.yaml`.
///
/// When one component fails, the others are stopped. Ctrl-C and SIGTERM are passed on to all; a second one kills at once.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl run                         the system in the working folder
  scl run examples/rover --for 5s stop after 5 seconds: a test run
  scl run rover/replay.yaml       another launch file

A launch file:
  transport: ipc                  # optional: ipc or tcp
  environment: {RUST_LOG: info}   # optional: for all programs
  components:
    sensor:
      command: [./sensor, --rate, 100]   # a list is executed as it is
    controller:
      command: ./controller 2>> log      # a text is given to the shell
      environment: {GAIN: 0.5}
      folder: control                    # default: the folder of the launch file

Exit code: 0 all ended in order or were stopped, 1 a component failed or had to be killed, 2 nothing could be started.")]
pub(crate) struct RunArguments {
    /// The system's folder, or a launch file.
    #[arg(default_value = ".")]
    folder: PathBuf,
    /// Stop by itself after this time, for example `5s`; that is success.
    #[arg(long = "for", value_name = "TIME", value_parser = parse_duration)]
    run_for: Option<Duration>,
    /// How long components may take to stop before they are killed.
    #[arg(long, value_name = "TIME", default_value = "5s", value_parser = parse_duration)]
    grace: Duration,
    /// Build the cargo package with optimizations.
    #[arg(long)]
    release: bool,
}

/// The body of `scl run`.
pub(crate) fn run(arguments: &RunArguments) -> ExitCode {
    let limits = Limits { run_for: arguments.run_for, grace: arguments.grace };
    let planned = plan::plan_programs(&arguments.folder, arguments.release);
    match planned.and_then(|programs| run_programs(&programs, limits).map_err(|problem| vec![problem])) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(problems) => {
            problems.iter().for_each(|problem| print_err(&format!("{problem}\n")));
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}

/// Starts the programs and waits for their ends; tells whether all was in order.
fn run_programs(programs: &[Program], limits: Limits) -> Result<bool, Problem> {
    let output = Arc::new(Output::new(programs.iter().map(|program| program.component.clone()).collect()));
    let (sender, events) = channel();
    listen_for_signals(sender.clone()).map_err(|error| Problem::new(format!("cannot listen for signals: {error}")))?;
    let reports = Reports::new(Arc::clone(&output));
    // Values are dropped in the opposite order: the guard ends while the programs are not reaped yet, so that the group
    // numbers that it knows are still theirs.
    let mut supervisor = Supervisor::new(events, &reports, limits);
    let mut guard = OrphanGuard::start().map_err(|error| Problem::new(format!("cannot start the guard: {error}")))?;
    for (component, program) in programs.iter().enumerate() {
        let started = Running::start(component, program, &mut guard, &output, &sender);
        supervisor.add(started.map_err(|error| cannot_start(program, &error))?);
    }
    let all_in_order = supervisor.wait_for_all();
    drop(guard);
    drop(supervisor);
    reports.finish(limits.grace);
    Ok(all_in_order)
}

fn cannot_start(program: &Program, error: &io::Error) -> Problem {
    Problem::new(format!("cannot start component `{}`: {error}", program.component))
        .help("the components that were started have been stopped again")
}

/// Turns the signals that ask us to stop into events. They are blocked in this thread and so in all that it starts, and
/// one thread waits for them.
fn listen_for_signals(events: Sender<Event>) -> io::Result<()> {
    let signals = stop_signals();
    signals.thread_block()?;
    thread::Builder::new().spawn(move || {
        while let Ok(signal) = signals.wait() {
            if events.send(Event::Asked(signal)).is_err() {
                break;
            }
        }
    })?;
    Ok(())
}
