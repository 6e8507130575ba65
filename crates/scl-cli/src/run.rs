//! `scl run`: builds and starts the program of every component, shows what they print, and stops them together.

use crate::load::{MaxSize, load_file, show_errors};
use clap::Args;
use scl_loader::Loaded;
use scl_plan::Assignment;
use scl_run::{SeatArgument, SystemNames};
use scl_terminal::{Problem, parse_duration, print_err};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

pub(crate) use scl_run::{GUARD_WORD, KEYS_WORD, START_WORD, keep_watch, tell_keys};

/// Build and start every component of a system and show what they print.
///
/// Reads `launch.yaml` in FOLDER, which says how each component is built and started. Without one, builds the cargo
/// package in FOLDER and starts the program named like each component of `topology.yaml`, or like its kind.
///
/// When a component fails, the others are stopped, unless the launch file says that it is restarted or not essential.
/// Ctrl-C and SIGTERM are passed on to all; a second one kills at once.
#[derive(Args)]
#[command(after_help = after_help())]
pub(crate) struct RunArguments {
    #[command(flatten)]
    programs: ProgramArguments,
    /// Start the components of this host of the launch file, and its gateway to the other hosts.
    #[arg(long, value_name = "HOST")]
    host: Option<String>,
    /// Stop after this time, for example `5s`, and succeed.
    #[arg(long = "for", value_name = "TIME", value_parser = parse_duration)]
    run_for: Option<Duration>,
    /// How long components without a `stop_within` in the launch file may take to stop before they are killed.
    #[arg(long, value_name = "TIME", default_value = "5s", value_parser = parse_duration)]
    grace: Duration,
}

/// Which programs to start, and how.
#[derive(Args)]
pub(crate) struct ProgramArguments {
    /// The system's folder, or a launch file.
    #[arg(default_value = ".")]
    folder: PathBuf,
    /// Use the programs of this profile of the launch file; several: later ones win.
    #[arg(long = "profile", value_name = "NAME")]
    profiles: Vec<String>,
    /// Start these components only.
    #[arg(long, value_name = "COMPONENT,...", value_delimiter = ',')]
    only: Vec<String>,
    /// Start all components but these.
    #[arg(long, value_name = "COMPONENT,...", value_delimiter = ',', conflicts_with = "only")]
    without: Vec<String>,
    /// Give a parameter this value, for example `controller.gain=2`; wins over the launch file. May be repeated.
    #[arg(long, value_name = "COMPONENT.PARAMETER=VALUE", value_parser = Assignment::parse)]
    set: Vec<Assignment>,
    /// Build the cargo package with optimizations.
    #[arg(long)]
    release: bool,
    /// Start the programs as they are, without building anything; `scl restart` builds nothing either.
    #[arg(long, conflicts_with = "release")]
    no_build: bool,
}

impl ProgramArguments {
    #[cfg(feature = "simulate")]
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// The options of a run of these programs on all hosts, without a limit.
    pub(crate) fn options(&self) -> scl_run::Options {
        scl_run::Options {
            folder: self.folder.clone(),
            profiles: self.profiles.clone(),
            only: self.only.clone(),
            without: self.without.clone(),
            set: self.set.clone(),
            release: self.release,
            no_build: self.no_build,
            ..scl_run::Options::default()
        }
    }
}

fn after_help() -> String {
    let example: String = scl_run::EXAMPLE_LAUNCH_FILE.lines().map(|line| format!("  {line}\n")).collect();
    format!(
        "\
Examples:
  scl run                         the system in the working folder
  scl run examples/rover --for 5s stop after 5 seconds: a test run
  scl run rover/replay.yaml       another launch file
  scl run --profile python        the programs of a profile
  scl run --only sensor           one component, while the others run elsewhere
  scl run --host board            on the board: its components and its gateway
  scl run --set controller.gain=2 another value of a parameter
  scl restart sensor              from another shell; `scl stop` stops everything

A launch file (docs/launch.md has all of it):
{example}
Exit code: 0 all ended cleanly or were stopped, 1 a component failed or had to be killed, 2 nothing could be started."
    )
}

/// Become a component's program, which ends when its parent ends.
#[derive(Args)]
pub(crate) struct StartArguments {
    /// The process that must be alive.
    parent: u32,
    /// A processor that the program may use; several: all of them.
    #[arg(long)]
    cpu: Vec<usize>,
    /// Its real-time priority.
    #[arg(long)]
    fifo: Option<u8>,
    /// How many file descriptors it may open.
    #[arg(long)]
    descriptors: Option<u64>,
    /// What it needs to take part in a simulation.
    #[arg(long)]
    seat: Option<OsString>,
    /// The program and its arguments.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, required = true)]
    command: Vec<OsString>,
}

/// The body of `scl run`.
pub(crate) fn run(arguments: &RunArguments) -> Result<ExitCode, Vec<Problem>> {
    let RunArguments { programs, host, run_for, grace } = arguments;
    let options = scl_run::Options { host: host.clone(), run_for: *run_for, grace: *grace, ..programs.options() };
    let all_ended_well = scl_run::run(&options, &component_names)?;
    Ok(if all_ended_well { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The body of `scl __start`.
pub(crate) fn start_component(arguments: &StartArguments) -> ExitCode {
    let StartArguments { cpu, fifo, descriptors, .. } = arguments;
    let placement = scl_run::Placement { cpu: cpu.clone(), fifo: *fifo, descriptors: *descriptors };
    match arguments.seat.as_deref().map(SeatArgument::parse).transpose() {
        Ok(seat) => scl_run::start_component(arguments.parent, &placement, seat.as_ref(), &arguments.command),
        Err(expected) => {
            print_err(&format!("scl: {expected}\n"));
            ExitCode::from(2)
        }
    }
}

pub(crate) fn component_names(topology: &Path) -> Option<SystemNames> {
    let loaded = load_file(topology, MaxSize::default());
    let names = names_of(&loaded);
    if names.is_none() {
        show_errors(&loaded);
    }
    names
}

/// The names of a topology without errors.
pub(crate) fn names_of(loaded: &Loaded) -> Option<SystemNames> {
    Some(SystemNames::of(loaded.topology.as_ref()?, loaded.model.system.is_some()))
}
