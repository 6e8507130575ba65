//! A simulation, in the process that was started for it.

use super::process::failed;
use super::report::Report;
use super::{ChosenFaults, SimulateArguments};
use crate::load::{MaxSize, load_file, show_errors};
use crate::run::component_names;
use clap::Args;
use rustix::process::{Signal, getppid, set_parent_process_death_signal};
use scl_conductor::{Conductor, Failure, Fault, Options, Scenario, unmet};
use scl_plan::SystemPlan;
use scl_record::format::SIMULATION_START;
use scl_record::recording::Recording;
use scl_run::{Played, Simulation, SimulationEnd, topology_of};
use scl_terminal::{Problem, print_err};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, SystemTime};

/// How long components without a `stop_within` may take to stop, in simulated time.
const GRACE: Duration = Duration::from_secs(5);

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
    /// The file into which it reports.
    #[arg(long)]
    report_to: Option<PathBuf>,
    /// Its seed.
    #[arg(long)]
    with_seed: Option<u64>,
    /// The faults that happen.
    #[arg(long, value_parser = ChosenFaults::parse)]
    with_faults: Option<ChosenFaults>,
    /// Which of the allowed processors it uses, counted from the last.
    #[arg(long)]
    processor: usize,
    /// Whether its programs are built already.
    #[arg(long)]
    built: bool,
    #[command(flatten)]
    arguments: SimulateArguments,
}

/// The body of `scl __simulate`.
pub(crate) fn simulate_here(here: &HereArguments) -> Result<ExitCode, Vec<Problem>> {
    let bound = set_parent_process_death_signal(Some(Signal::KILL));
    bound.map_err(|error| vec![failed("prepare the simulation", error.into())])?;
    if getppid().is_none_or(|current| current.as_raw_pid().cast_unsigned() != here.parent) {
        return Ok(ExitCode::FAILURE);
    }
    let SimulateArguments { programs, until, seed, speed, patience, most_turns, played, .. } = &here.arguments;
    let seed = here.with_seed.unwrap_or(*seed);
    // Tools that look at it live in real time, and would show other times.
    let start = speed.map_or(SIMULATION_START, |_| {
        Duration::from_secs(SystemTime::UNIX_EPOCH.elapsed().unwrap_or_default().as_secs())
    });
    let (speed, patience, most_turns, processor) = (*speed, *patience, *most_turns, here.processor);
    let options = Options { seed, start, speed, patience, most_turns, processor };
    let scenario = here.arguments.scenario.as_deref().map(|file| read_scenario(file, here)).transpose()?;
    let scenario = scenario.unwrap_or_default();
    let until = until.or(scenario.until);
    let chosen = here.with_faults.as_ref().or(here.arguments.faults.as_ref());
    let faults = chosen_faults(&scenario, seed, until, chosen).map_err(|problem| vec![problem])?;
    let conductor = Conductor::new(options, &scenario, faults.clone(), &here.runtime_folder);
    let mut conductor = conductor.map_err(|error| vec![failed("prepare the simulation", error)])?;
    // What is expected of messages is looked up in the recording.
    let own = (!scenario.expectations.is_empty()).then(|| here.runtime_folder.join("simulation.mcap"));
    let recording = here.record_to.clone().or(own);
    let programs = programs.options();
    let no_build = programs.no_build || here.built;
    let played = here.arguments.replay.clone().map(|recording| Played { recording, components: played.clone() });
    let run = scl_run::Options { run_for: until, grace: GRACE, no_build, played, ..programs };
    if speed.is_some() {
        print_err(&format!("scl: `SCL_RUNTIME_DIR={} scl top` looks at it\n", here.runtime_folder.display()));
    }
    let simulation = Simulation { conductor: &mut conductor, recording: recording.clone() };
    let end = scl_run::simulate(&run, &component_names, simulation)?;
    let failures = recording.map_or_else(|| Ok(Vec::new()), |recording| failures(&scenario, &recording, &end, start));
    let failures = failures.map_err(|problem| vec![problem])?;
    failures.iter().for_each(|failure| print_err(&failure.problem.to_string()));
    let happened: Vec<Fault> = faults.into_iter().filter(|fault| fault.at <= now(&conductor)).collect();
    tell_how_to_repeat(&failures, &happened, seed);
    if let Some(file) = &here.report_to {
        let texts = failures.iter().map(|failure| failure.problem.message().to_owned());
        let failed_component = (!end.well).then(|| "a component has failed".to_owned());
        let report = Report::new(texts.chain(failed_component).collect(), &happened);
        report.write(file).map_err(|error| vec![failed("write the report", error)])?;
    }
    report(&conductor);
    Ok(if end.well && failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn read_scenario(file: &Path, here: &HereArguments) -> Result<Scenario, Vec<Problem>> {
    let shown = file.display().to_string();
    let unreadable = |error| vec![Problem::new(format!("cannot read the scenario: {error}")).at(shown.clone())];
    let text = std::fs::read_to_string(file).map_err(unreadable)?;
    let topology = topology_of(here.arguments.programs.folder())?;
    let no_topology = || {
        let problem = Problem::new("there is no topology file, so a scenario cannot be checked");
        vec![problem.help("put `topology.yaml` beside the launch file")]
    };
    Scenario::read(&shown, &text, &system_plan(&topology.ok_or_else(no_topology)?)?)
}

fn system_plan(topology: &Path) -> Result<SystemPlan, Vec<Problem>> {
    let loaded = load_file(topology, MaxSize::default());
    loaded.system_plan().ok_or_else(|| {
        show_errors(&loaded);
        vec![Problem::new("the topology has errors, so nothing was started").at(topology.display().to_string())]
    })
}

fn chosen_faults(
    scenario: &Scenario,
    seed: u64,
    until: Option<Duration>,
    chosen: Option<&ChosenFaults>,
) -> Result<Vec<Fault>, Problem> {
    let mut faults = scenario.faults(seed, until)?;
    if let Some(ChosenFaults(numbers)) = chosen {
        if let Some(unknown) = numbers.iter().find(|number| !faults.iter().any(|fault| fault.number == **number)) {
            let problem = Problem::new(format!("there is no fault {unknown} with seed {seed}"));
            return Err(problem.help(format!("choose from 1 to {}, or `none`", faults.len())));
        }
        faults.retain(|fault| numbers.contains(&fault.number));
    }
    Ok(faults)
}

fn failures(
    scenario: &Scenario,
    recording: &Path,
    end: &SimulationEnd,
    start: Duration,
) -> Result<Vec<Failure>, Problem> {
    if scenario.expectations.is_empty() {
        return Ok(Vec::new());
    }
    let exit = |component: &str| end.exits.iter().find(|(name, _)| name == component).map(|(_, code)| *code);
    unmet(&scenario.expectations, &Recording::open(&[recording.to_owned()])?, &exit, start)
}

/// Prints what went wrong before the first failure, and the seed.
fn tell_how_to_repeat(failures: &[Failure], happened: &[Fault], seed: u64) {
    if failures.is_empty() {
        return;
    }
    let first = failures.iter().map(|failure| failure.at.unwrap_or(Duration::MAX)).min().unwrap_or_default();
    let before: Vec<String> = happened.iter().filter(|fault| fault.at <= first).map(Fault::to_string).collect();
    before.iter().for_each(|fault| print_err(&format!("  = note: {fault}\n")));
    print_err(&format!("  = help: `--seed {seed}` repeats this; with `--faults`, only some of the faults happen\n\n"));
}

fn now(conductor: &Conductor) -> Duration {
    scl_run::Conductor::now(conductor)
}

fn report(conductor: &Conductor) {
    let (simulated, took) = (now(conductor).as_secs_f64(), conductor.took().as_secs_f64());
    print_err(&format!(
        "scl: simulated {simulated:.3} s in {took:.1} s, {:.1} times as fast as real time, with {} turns\n",
        simulated / took,
        conductor.turns()
    ));
}
