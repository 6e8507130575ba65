//! Builds and starts the program of every component of a system, shows what they print, and stops them together.
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
mod program;
mod reports;
mod selection;
mod supervisor;

pub use launch_file::EXAMPLE as EXAMPLE_LAUNCH_FILE;
pub use orphan_guard::{GUARD_WORD, START_WORD, keep_watch, start_component};
pub use plan::ComponentNames;

use children::{Event, Role, Running};
use ending::Ending;
use nix::sys::signal::Signal;
use orphan_guard::{OrphanGuard, stop_signals};
use output::Output;
use plan::RunPlan;
use program::{Build, Program};
use reports::Reports;
use scl_terminal::Problem;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::thread;
use std::time::Duration;
use supervisor::{Outcome, Supervisor};

/// What to run, and how long.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The system's folder, or a launch file.
    pub folder: PathBuf,
    /// Profiles of the launch file; later ones win.
    pub profiles: Vec<String>,
    /// The components to start; all if empty.
    pub only: Vec<String>,
    /// Components not to start.
    pub without: Vec<String>,
    /// Whether to build the cargo package with optimizations.
    pub release: bool,
    /// When to stop the components without being asked, if ever.
    pub run_for: Option<Duration>,
    /// How long components may take to stop before they are killed.
    pub grace: Duration,
}

/// Builds, starts the components, waits until all have ended, and returns true if all ended in order or were stopped.
///
/// `component_names` reads the topology file.
///
/// # Errors
///
/// Every reason why the system could not be started.
pub fn run(options: &Options, component_names: ComponentNames<'_>) -> Result<bool, Vec<Problem>> {
    let plan = plan::plan_run(options, component_names)?;
    let builds = plan.builds.iter().map(Build::label);
    let names = builds.chain(plan.components.iter().map(|component| component.name.as_str()));
    let output = Arc::new(Output::new(names.map(str::to_owned).collect()));
    handle_stop_signals().map_err(|error| vec![Problem::new(format!("cannot handle signals: {error}"))])?;
    // Before the first thread, which inherits it: a thread that does not block them would end the process.
    let blocked = stop_signals().thread_block();
    blocked.map_err(|error| vec![Problem::new(format!("cannot block signals: {error}"))])?;
    let reports = Reports::new(Arc::clone(&output));
    let ended = run_plan(&plan, options, &output, &reports);
    reports.finish(options.grace);
    ended
}

/// Programs inherit which signals are ignored, but not which are handled. A shell that starts `scl run` in the background
/// ignores SIGINT, and the programs could not be stopped by it. The flags are never read: the signals are blocked.
fn handle_stop_signals() -> io::Result<()> {
    for signal in &stop_signals() {
        signal_hook::flag::register(signal as i32, Arc::default())?;
    }
    Ok(())
}

fn run_plan(plan: &RunPlan, options: &Options, output: &Arc<Output>, reports: &Reports) -> Result<bool, Vec<Problem>> {
    let failed = |message: &str, error: io::Error| vec![Problem::new(format!("cannot {message}: {error}"))];
    let (events, received) = channel();
    listen_for_signals(events.clone()).map_err(|error| failed("listen for signals", error))?;
    // Values are dropped in the opposite order: the guard ends while the programs are not reaped yet, so that the group
    // numbers that it knows are still theirs.
    let mut supervisor = Supervisor::new(received, reports, options.grace);
    let mut guard = OrphanGuard::start().map_err(|error| failed("start the guard", error))?;
    let mut start = |supervisor: &mut Supervisor<'_>, program: &Program, role| {
        let running = Running::start(supervisor.next_index(), program, role, &mut guard, output, &events)?;
        supervisor.add(running, role);
        io::Result::Ok(())
    };
    for build in &plan.builds {
        build.check().map_err(|problem| vec![problem])?;
        reports.announce(&format!("building {}: {}", build.owner(), build.shown_command()));
        start(&mut supervisor, &build.program, Role::Build)
            .map_err(|error| failed(&format!("start the build of {}", build.owner()), error))?;
        match supervisor.wait_for_all() {
            Outcome::InOrder => {}
            Outcome::Failed(ending) => return Err(vec![failed_build(build, ending)]),
            Outcome::Stopped(signal) => return Err(vec![stopped_build(signal)]),
        }
    }
    let problems: Vec<Problem> = plan.components.iter().filter_map(|component| component.check().err()).collect();
    if !problems.is_empty() {
        return Err(problems);
    }
    supervisor.start_time(options.run_for);
    for component in &plan.components {
        start(&mut supervisor, &component.program, Role::Component)
            .map_err(|error| vec![cannot_start(&component.name, &error)])?;
    }
    Ok(!matches!(supervisor.wait_for_all(), Outcome::Failed(_)))
}

fn failed_build(build: &Build, ending: Ending) -> Problem {
    let problem = Problem::new(format!("the build of {} failed, so nothing was started", build.owner()));
    let problem = problem.note(format!("`{}` {ending}", build.shown_command()));
    // As shells report it.
    if ending == Ending::Exited(127) { problem.help("install the command that was not found") } else { problem }
}

fn stopped_build(signal: Signal) -> Problem {
    Problem::new(format!("stopped on {} during a build, so nothing was started", signal.as_str()))
}

fn cannot_start(component: &str, error: &io::Error) -> Problem {
    Problem::new(format!("cannot start component `{component}`: {error}"))
        .help("the components that were started have been stopped again")
}

/// Turns the signals that ask us to stop, which are blocked in all threads, into events.
fn listen_for_signals(events: Sender<Event>) -> io::Result<()> {
    let signals = stop_signals();
    thread::Builder::new().spawn(move || {
        while let Ok(signal) = signals.wait() {
            if events.send(Event::Asked(signal)).is_err() {
                break;
            }
        }
    })?;
    Ok(())
}
