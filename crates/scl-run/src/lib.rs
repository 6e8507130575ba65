//! Builds and starts the program of every component of a system, shows what they print, and stops them together.
//!
//! This crate implements `scl run`. [`run`] also starts the calling program again, which must therefore provide three
//! hidden commands: [`START_WORD`], which calls [`start_component`], [`GUARD_WORD`], which calls [`keep_watch`], and
//! [`KEYS_WORD`], which calls [`tell_keys`].
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod already_running;
mod cargo;
mod children;
mod command_line;
mod component;
mod conductor;
pub mod control;
mod deployment;
mod ending;
mod event;
mod family;
mod gateway_program;
mod kept_values;
mod launch_file;
mod lifecycle;
mod linkage;
mod lock;
mod log_file;
mod member;
mod notify;
mod orphan_guard;
mod orphans;
mod output;
mod own_file;
mod placement;
mod plan;
mod policy;
mod process_group;
mod process_stat;
mod program;
mod recorder;
mod requests;
mod restarts;
mod run_clock;
mod run_state;
mod seat;
mod selection;
mod sockets;
mod streams;
mod summary;
mod supervisor;
mod system_names;
mod terminal;
mod units;

pub use conductor::{Conductor, Pause, Seat};
pub use deployment::{Deployment, Host};
pub use launch_file::EXAMPLE as EXAMPLE_LAUNCH_FILE;
pub use launch_file::{CheckedLaunchFile, LaunchTopology, check_launch_file, launch_keys};
pub use launch_file::{LAUNCH_RULES, explain_launch_rule};
pub use log_file::{LogEntry, LogFolder, LogReader, LogStream};
pub use orphan_guard::{GUARD_WORD, START_WORD, keep_watch, start_component};
pub use placement::Placement;
pub use plan::{ComponentNames, DeployedSystem, read_deployment, topology_of};
pub use seat::{SEAT_FORMAT, SeatArgument};
pub use system_names::{SystemNames, running_systems};
pub use terminal::{KEYS_WORD, tell_keys};
pub use units::{Unit, UnitOptions, systemd_units};

use component::Component;
use ending::{Ending, name_of};
use event::Event;
use kept_values::KeptValues;
use log_file::LogFile;
use member::{Member, Messages, Role};
use nix::sys::signal::SigSet;
use orphan_guard::{OrphanGuard, STOP_SIGNALS};
use output::Output;
use plan::{Built, RunPlan};
use policy::Policy;
use program::{Build, Program};
use rustix::process::Signal;
use scl_plan::Assignment;
use scl_terminal::{Problem, print_err};
use signal_hook::iterator::Signals;
use sockets::Sockets;
use std::ffi::OsString;
use std::io;
use std::path::PathBuf;
use std::sync::mpsc::{Sender, channel};
use std::thread;
use std::time::Duration;
use supervisor::{Outcome, Supervisor, Surroundings};

/// What to run, and for how long.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The system's folder, or a launch file.
    pub folder: PathBuf,
    /// Profiles of the launch file; later ones win.
    pub profiles: Vec<String>,
    /// The components to start; all if empty.
    pub only: Vec<String>,
    /// The host of the launch file whose components and gateway are started. If `None`, the components of all hosts are
    /// started, without a gateway.
    pub host: Option<String>,
    /// Components not to start.
    pub without: Vec<String>,
    /// Values of parameters, which win over all others; later ones win.
    pub set: Vec<Assignment>,
    /// The components that a recording plays in place of their programs.
    pub played: Option<Played>,
    /// Whether to build the cargo package with optimizations.
    pub release: bool,
    /// Whether to start the programs as they are, without building anything.
    pub no_build: bool,
    /// The time after which the components are stopped, if any.
    pub run_for: Option<Duration>,
    /// How long components without a `stop_within` may take to stop before they are killed.
    pub grace: Duration,
}

/// Components that a recording plays.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Played {
    /// The recording.
    pub recording: PathBuf,
    /// The components.
    pub components: Vec<String>,
}

/// How a system is simulated.
#[derive(Debug)]
pub struct Simulation<'c> {
    /// Gives the programs their turns.
    pub conductor: &'c mut dyn Conductor,
    /// The file into which the messages of all gates are recorded, which must not exist.
    pub recording: Option<PathBuf>,
}

/// Builds and starts the components, and waits until all have ended. Returns true unless an essential component failed.
///
/// `component_names` reads the topology file.
///
/// # Errors
///
/// Every reason why the system could not be started.
pub fn run(options: &Options, component_names: ComponentNames<'_>) -> Result<bool, Vec<Problem>> {
    Ok(run_with(options, component_names, None)?.well)
}

/// How a simulation has ended.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SimulationEnd {
    /// Whether no essential component has failed.
    pub well: bool,
    /// The components whose last program has ended by itself before the end, with its exit code.
    pub exits: Vec<(String, i32)>,
}

/// Like [`run`], in simulated time, which begins once everything is built.
///
/// # Errors
///
/// Every reason why the system could not be started, or the simulation not go on.
pub fn simulate(
    options: &Options,
    component_names: ComponentNames<'_>,
    simulation: Simulation<'_>,
) -> Result<SimulationEnd, Vec<Problem>> {
    run_with(options, component_names, Some(simulation))
}

fn run_with(
    options: &Options,
    component_names: ComponentNames<'_>,
    simulation: Option<Simulation<'_>>,
) -> Result<SimulationEnd, Vec<Problem>> {
    let mut plan = plan::plan_run(options, component_names)?;
    already_running::check(&plan).map_err(|problem| vec![problem])?;
    plan.gateway.as_ref().map_or(Ok(()), gateway_program::check)?;
    if let Some(recording) = simulation.as_ref().and_then(|simulation| simulation.recording.as_deref()) {
        let (folder, _) = plan::find_folder(&options.folder).map_err(|problem| vec![problem])?;
        plan.recorder = Some(recorder::plan_recorder(&plan, folder, recording).map_err(|problem| vec![problem])?);
    }
    let conductor = simulation.map(|simulation| simulation.conductor);
    let builds = plan.builds.iter().map(Build::label);
    let names = builds.chain(plan.programs().map(|component| component.name.as_str()));
    let names = names.map(str::to_owned).collect();
    let (sender, events) = channel();
    let signals = listen_for_signals(sender.clone());
    signals.map_err(|error| vec![Problem::new(format!("cannot handle signals: {error}"))])?;
    // What a simulation prints is no record of what has happened.
    let logs = if conductor.is_some() { plan.programs().map(|_| None).collect() } else { open_logs(&plan) };
    let output = Output::start(names, logs, sender.clone());
    let ended = run_plan(&mut plan, options, Surroundings { output: &output, events, sender }, conductor);
    output.finish(options.grace);
    ended
}

/// Opens the log of each program. A log that cannot be opened is reported, and its program runs without one.
fn open_logs(plan: &RunPlan) -> Vec<Option<LogFile>> {
    let system = plan.system.as_deref();
    let folder = system.and_then(|system| LogFolder::of(system, &|variable| std::env::var_os(variable)));
    let open = |component: &Component| {
        let log = LogFile::open(folder.as_ref()?, &component.name);
        log.map_err(|report| print_err(&format!("scl: {report}; its output is not logged\n"))).ok()
    };
    plan.programs().map(open).collect()
}

fn run_plan(
    plan: &mut RunPlan,
    options: &Options,
    surroundings: Surroundings<'_>,
    conductor: Option<&mut dyn Conductor>,
) -> Result<SimulationEnd, Vec<Problem>> {
    let failed = |message: &str, error: io::Error| vec![Problem::new(format!("cannot {message}: {error}"))];
    let (output, sender) = (surroundings.output, surroundings.sender.clone());
    orphans::adopt().map_err(|error| failed("take care of orphaned processes", error))?;
    let sockets = Sockets::open(plan, &sender)?;
    let guard = OrphanGuard::start().map_err(|error| failed("start the guard", error))?;
    let mut supervisor = Supervisor::new(surroundings, guard, sockets.as_ref().map(|sockets| &*sockets.notify));
    if options.no_build {
        plan.find_programs_built_before()?;
    } else if !plan.builds.is_empty() {
        let built =
            run_builds(&plan.builds, options.grace, &mut supervisor, output).map_err(|problem| vec![problem])?;
        plan.take_built(&built)?;
        // Check again: another `scl run` may have started these components during the build.
        already_running::check(plan).map_err(|problem| vec![problem])?;
    }
    let check = |component: &Component| {
        component.check()?;
        if conductor.is_some() { component.check_linkage() } else { Ok(()) }
    };
    let problems: Vec<Problem> = plan.programs().filter_map(|component| check(component).err()).collect();
    if !problems.is_empty() {
        return Err(problems);
    }
    let gateways = plan.gateway.iter().map(|gateway| (gateway, Role::Gateway));
    let recorders = plan.recorder.iter().map(|recorder| (recorder, Role::Recorder));
    let programs =
        gateways.chain(recorders).chain(plan.components.iter().map(|component| (component, Role::Component)));
    let members = programs.enumerate();
    let members = members.map(|(index, (program, role))| member(program, role, plan.builds.len() + index));
    let members: Vec<Member<'_>> = members.collect();
    let control = sockets.as_ref().and_then(|sockets| sockets.open_control(&sender));
    sockets.iter().for_each(|sockets| sockets.keep(control.as_ref(), output));
    // With `--no-build`, a restart builds nothing either.
    let builds = if options.no_build { &[][..] } else { plan.builds.as_slice() };
    // Processes that a build leaves behind, such as a compiler's server, are not ended.
    let left_by_builds = orphans::adopted();
    supervisor.follow_conductor(conductor).map_err(|error| failed("watch the programs", error))?;
    let outcome = supervisor.run(&members, builds, options.run_for);
    orphans::kill_adopted(&left_by_builds);
    supervisor.broken().map_or(Ok(()), |problem| Err(vec![problem]))?;
    let exits = supervisor.exits.iter().map(|(index, code)| (members[*index].name.to_owned(), *code)).collect();
    Ok(SimulationEnd { well: !matches!(outcome, Outcome::Failed(_)), exits })
}

/// Runs the builds one after the other, and returns the programs that they report.
fn run_builds(
    builds: &[Build],
    grace: Duration,
    supervisor: &mut Supervisor<'_, '_>,
    output: &Output,
) -> Result<Built, Problem> {
    let mut built = Built::new();
    for (label, build) in builds.iter().enumerate() {
        build.check()?;
        output.announce(&format!("building {}: {}", build.owner(), build.shown_command()));
        let mut program = Program { command: build.command(), ..build.program.clone() };
        let messages = build.cargo_choices.as_ref().map(|_| Messages::default());
        if messages.is_some() {
            program.command.extend(cargo::MESSAGES.map(OsString::from));
        }
        let policy = Policy { stop_within: grace, ..Policy::default() };
        let (name, role, messages_of_member) = (build.label(), Role::Build, messages.clone());
        let member = Member {
            name,
            label,
            role,
            program: &program,
            policy,
            messages: messages_of_member,
            entry: None,
            kept: KeptValues::default(),
        };
        match supervisor.run(&[member], &[], None) {
            Outcome::InOrder => {}
            Outcome::Failed(ending) => return Err(failed_build(build, ending)),
            Outcome::Stopped(signal) => {
                let signal = name_of(signal);
                return Err(Problem::new(format!("stopped on {signal} during a build, so nothing was started")));
            }
        }
        built.push(messages.map_or_else(Vec::new, |messages| cargo::read_artifacts(&messages.take())));
    }
    Ok(built)
}

fn member(component: &Component, role: Role, label: usize) -> Member<'_> {
    let Component { name, program, policy, entry, kept, .. } = component;
    let (policy, entry, kept) = (policy.clone(), entry.as_deref(), kept.clone());
    Member { name, label, role, program, policy, messages: None, entry, kept }
}

/// Returns the problem that reports a failed build.
fn failed_build(build: &Build, ending: Option<Ending>) -> Problem {
    let problem = Problem::new(format!("the build of {} failed, so nothing was started", build.owner()));
    let Some(ending) = ending else { return problem };
    let problem = problem.note(format!("`{}` {ending}", build.shown_command()));
    // Shells report a missing command as exit code 127.
    if ending == Ending::Exited(127) { problem.help("install the command that was not found") } else { problem }
}

/// Turns the signals that ask us to stop into events.
///
/// Programs inherit which signals are ignored, but not which are handled. A shell that starts `scl run` in the
/// background ignores SIGINT, and without a handler the programs could not be stopped by it.
fn listen_for_signals(events: Sender<Event>) -> io::Result<()> {
    // A parent that waits for signals may have blocked them, and this process has inherited its mask. All threads
    // started from here on inherit the mask of this one.
    SigSet::empty().thread_set_mask()?;
    let mut signals = Signals::new(STOP_SIGNALS)?;
    thread::Builder::new().spawn(move || {
        for signal in signals.forever().filter_map(Signal::from_named_raw) {
            if events.send(Event::Signalled(signal)).is_err() {
                break;
            }
        }
    })?;
    Ok(())
}
