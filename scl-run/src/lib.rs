//! Starts the program of every component of a system, shows what they print, and stops them together.
//!
//! This is the work behind `scl run`. The program that calls [`run`] must offer two hidden commands to itself:
//! [`START_WORD`], which calls [`start_component`], and [`GUARD_WORD`], which calls [`keep_watch`].
#![cfg_attr(test, allow(clippy::unwrap_used))]

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

pub use orphan_guard::{GUARD_WORD, START_WORD, keep_watch, start_component};
pub use plan::ComponentNames;
pub use problem::Problem;

use children::{Event, Running};
use orphan_guard::{OrphanGuard, stop_signals};
use output::Output;
use program::Program;
use reports::Reports;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::thread;
use std::time::Duration;
use supervisor::{Limits, Supervisor};

/// What to run, and how long.
#[derive(Debug, Clone)]
pub struct Options {
    /// The system's folder, or a launch file.
    pub folder: PathBuf,
    /// Whether to build the cargo package with optimizations.
    pub release: bool,
    /// When to stop the components without being asked, if ever.
    pub run_for: Option<Duration>,
    /// How long components may take to stop before they are killed.
    pub grace: Duration,
}

/// Starts every component, waits until all have ended, and returns true if all ended in order or were stopped.
///
/// `component_names` reads the topology file beside the launch file.
///
/// # Errors
///
/// Every reason why the system could not be started.
pub fn run(options: &Options, component_names: ComponentNames<'_>) -> Result<bool, Vec<Problem>> {
    let limits = Limits { run_for: options.run_for, grace: options.grace };
    let programs = plan::plan_programs(&options.folder, options.release, component_names)?;
    run_programs(&programs, limits).map_err(|problem| vec![problem])
}

/// Starts the programs and waits for their ends. Returns true if all was in order.
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
