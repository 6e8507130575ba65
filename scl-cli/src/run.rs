//! `scl run`: starts the program of every component, shows what they print, and stops them together.

use crate::duration::parse_duration;
use crate::load::{MaxSize, load_file, show_errors};
use crate::print::print_err;
use clap::Args;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

pub(crate) use scl_run::{GUARD_WORD, START_WORD, keep_watch};

/// Exit code: nothing could be started.
const COULD_NOT_RUN: u8 = 2;

/// Start every component of a system and show what they print.
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
    /// Stop after this time, for example `5s`, and succeed.
    #[arg(long = "for", value_name = "TIME", value_parser = parse_duration)]
    run_for: Option<Duration>,
    /// How long components may take to stop before they are killed.
    #[arg(long, value_name = "TIME", default_value = "5s", value_parser = parse_duration)]
    grace: Duration,
    /// Build the cargo package with optimizations.
    #[arg(long)]
    release: bool,
}

/// Become a component's program, which ends when its parent ends.
#[derive(Args)]
pub(crate) struct StartArguments {
    /// The process that must be alive.
    parent: u32,
    /// The program and its arguments.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, required = true)]
    command: Vec<OsString>,
}

/// The body of `scl run`.
pub(crate) fn run(arguments: &RunArguments) -> ExitCode {
    let options = scl_run::Options {
        folder: arguments.folder.clone(),
        release: arguments.release,
        run_for: arguments.run_for,
        grace: arguments.grace,
    };
    match scl_run::run(&options, &component_names) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(problems) => {
            problems.iter().for_each(|problem| print_err(&format!("{problem}\n")));
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}

/// The body of `scl __start`.
pub(crate) fn start_component(arguments: &StartArguments) -> ExitCode {
    scl_run::start_component(arguments.parent, &arguments.command)
}

fn component_names(topology: &Path) -> Option<Vec<String>> {
    let loaded = load_file(topology, MaxSize::default());
    let Some(topology) = &loaded.topology else {
        show_errors(&loaded);
        return None;
    };
    Some(topology.components().map(|(_, component)| component.name().to_owned()).collect())
}
