//! `scl simulate`: runs a system in simulated time.

mod twice;

use crate::run::{ProgramArguments, component_names};
use clap::Args;
use rustix::process::{Pid, Signal, getppid, kill_process, set_parent_process_death_signal};
use scl_run::Simulation;
use scl_simulate::Conductor;
use scl_terminal::{Problem, parse_duration, print_err};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::ffi::OsStr;
use std::io;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::thread;
use std::time::Duration;

/// The hidden command that is one simulation: `scl __simulate PARENT FOLDER -- ARGUMENTS...`.
pub(crate) const RUN_WORD: &str = "__simulate";

/// How long components without a `stop_within` may take to stop, in simulated time.
const GRACE: Duration = Duration::from_secs(5);

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

Two simulations with the same programs, files, arguments and seed do the same. docs/simulate.md says what a program must
not do for that, and which programs cannot take part.

Exit code: 0 all ended cleanly or were stopped, 1 a component failed or had to be killed, 2 nothing could be started, or
the simulation could not go on.")]
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
    /// Simulate twice, and say what differs first if anything does.
    #[arg(long)]
    twice: bool,
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

/// Simulate a system in this process.
#[derive(Args)]
pub(crate) struct HereArguments {
    /// The process that must be alive.
    parent: u32,
    /// The runtime folder of this simulation.
    runtime_folder: PathBuf,
    /// The file into which it is recorded.
    #[arg(long)]
    record_to: Option<PathBuf>,
    /// Whether its programs are built already.
    #[arg(long)]
    built: bool,
    #[command(flatten)]
    arguments: SimulateArguments,
}

fn parse_speed(text: &str) -> Result<f64, String> {
    let speed = text.parse().ok().filter(|speed: &f64| speed.is_finite() && *speed > 0.0);
    speed.ok_or_else(|| "expected a number above 0, for example `1` or `0.5`".to_owned())
}

/// The body of `scl simulate`: a process of its own has the folder of the simulation as its runtime folder.
pub(crate) fn simulate(arguments: &SimulateArguments) -> Result<ExitCode, Problem> {
    if let Some(output) = arguments.output.as_ref().filter(|output| output.exists()) {
        let problem = Problem::new(format!("`{}` exists already", output.display()));
        return Err(problem.help("delete it, or choose another name"));
    }
    if arguments.twice {
        return simulate_twice(arguments);
    }
    run_once(arguments.output.as_deref(), false)
}

/// Runs a simulation that is recorded, and a second one. The exit code is that of the first if both do the same.
fn simulate_twice(arguments: &SimulateArguments) -> Result<ExitCode, Problem> {
    let folder = tempfile::Builder::new().prefix("scl-").tempdir();
    let folder = folder.map_err(|error| failed("create a folder for recordings", error))?;
    let first = arguments.output.clone().unwrap_or_else(|| folder.path().join("first.mcap"));
    let second = folder.path().join("second.mcap");
    let code = run_once(Some(&first), false)?;
    if !first.exists() {
        return Ok(code);
    }
    // Built by the first one.
    run_once(Some(&second), true)?;
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

/// Runs one simulation with the arguments of this one.
fn run_once(output: Option<&Path>, is_built: bool) -> Result<ExitCode, Problem> {
    let folder = tempfile::Builder::new().prefix("scl-").tempdir();
    let folder = folder.map_err(|error| failed("create a folder for the simulation", error))?;
    let mut signals = Signals::new([SIGHUP, SIGINT, SIGTERM]).map_err(|error| failed("handle signals", error))?;
    let mut command = Command::new("/proc/self/exe");
    command.arg0("scl").arg(RUN_WORD).arg(std::process::id().to_string()).arg(folder.path());
    command.args(output.iter().flat_map(|output| [OsStr::new("--record-to"), output.as_os_str()]));
    command.args(is_built.then_some("--built")).args(std::env::args_os().skip(2));
    // A group of its own, so that Ctrl-C reaches it only once.
    let command = command.env("SCL_RUNTIME_DIR", folder.path()).process_group(0);
    #[expect(clippy::disallowed_methods, reason = "it is waited for below")]
    let mut process = command.spawn().map_err(|error| failed("start the simulation", error))?;
    let simulation = Pid::from_child(&process);
    let handle = signals.handle();
    let passing_on = thread::spawn(move || {
        for signal in signals.forever().filter_map(Signal::from_named_raw) {
            // It may have just ended.
            let _ended = kill_process(simulation, signal);
        }
    });
    let ended = process.wait().map_err(|error| failed("wait for the simulation", error))?;
    handle.close();
    let _handled = passing_on.join();
    let code = ended.code().and_then(|code| u8::try_from(code).ok());
    code.map(ExitCode::from).ok_or_else(|| Problem::new(format!("the simulation was ended by {ended}")))
}

/// The body of `scl __simulate`.
pub(crate) fn simulate_here(here: &HereArguments) -> Result<ExitCode, Vec<Problem>> {
    let bound = set_parent_process_death_signal(Some(Signal::KILL));
    bound.map_err(|error| vec![failed("prepare the simulation", error.into())])?;
    if getppid().is_none_or(|current| current.as_raw_pid().cast_unsigned() != here.parent) {
        return Ok(ExitCode::FAILURE);
    }
    let SimulateArguments { programs, until, seed, speed, patience, most_turns, .. } = &here.arguments;
    let options = scl_simulate::Options { seed: *seed, speed: *speed, patience: *patience, most_turns: *most_turns };
    let conductor = Conductor::new(options, &here.runtime_folder);
    let mut conductor = conductor.map_err(|error| vec![failed("write the library", error)])?;
    let programs = programs.options();
    let no_build = programs.no_build || here.built;
    let run = scl_run::Options { run_for: *until, grace: GRACE, no_build, ..programs };
    let simulation = Simulation { conductor: &mut conductor, recording: here.record_to.clone() };
    let all_ended_well = scl_run::simulate(&run, &component_names, simulation)?;
    report(&conductor);
    Ok(if all_ended_well { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn report(conductor: &Conductor) {
    let (simulated, took) = (scl_run::Conductor::now(conductor).as_secs_f64(), conductor.took().as_secs_f64());
    print_err(&format!(
        "scl: simulated {simulated:.3} s in {took:.1} s, {:.1} times as fast as real time, with {} turns\n",
        simulated / took,
        conductor.turns()
    ));
}

fn failed(what: &str, error: io::Error) -> Problem {
    Problem::new(format!("cannot {what}: {error}"))
}
