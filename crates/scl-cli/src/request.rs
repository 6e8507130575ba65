//! `scl restart` and `scl stop`: asking the `scl run` of the components, and showing what happened.

use crate::exit::print_problems;
use crate::format::FormatArgument;
use crate::load::{named_after_here, system_of_folder};
use clap::Args;
use scl_run::control::{Command, ComponentReport, ControlOptions, ask};
use scl_terminal::{Problem, escape};
use serde_json::json;
use std::process::ExitCode;

/// Build components that `scl run` has started and restart them, while the others keep running.
///
/// If `scl run` has built their programs, these are rebuilt first, while the old processes run. If that fails, the old
/// processes keep running. Waits until the new processes run; for components with `ready_within` in the launch file,
/// until they are ready. Components that have ended are started.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl restart sensor
  scl restart sensor gps --system rover

Exit code: 0 restarted, 1 a build failed and the old process keeps running, or a component failed again, 2 nothing was done.")]
pub(crate) struct RestartArguments {
    /// The components.
    #[arg(value_name = "COMPONENT", required = true)]
    components: Vec<String>,
    /// Start the programs as they are, without building them first.
    #[arg(long)]
    no_build: bool,
    #[command(flatten)]
    request: RequestArguments,
}

/// The body of `scl restart`.
pub(crate) fn restart(arguments: &RestartArguments) -> Result<ExitCode, Vec<Problem>> {
    request(Command::Restart, &arguments.components, !arguments.no_build, &arguments.request)
}

/// Stop components that `scl run` has started, and wait until they have ended.
///
/// Without a name, everything is stopped and each `scl run` of the system ends. A component that is stopped by its name
/// is not restarted, whatever its `restart` says; the others keep running.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl stop                        everything
  scl stop sensor                 one component
  scl stop --system rover         where several systems run

Exit code: 0 stopped, 1 something was not stopped, 2 nothing was done.")]
pub(crate) struct StopArguments {
    /// The components; all if none is named.
    #[arg(value_name = "COMPONENT")]
    components: Vec<String>,
    #[command(flatten)]
    request: RequestArguments,
}

/// The body of `scl stop`.
pub(crate) fn stop(arguments: &StopArguments) -> Result<ExitCode, Vec<Problem>> {
    request(Command::Stop, &arguments.components, false, &arguments.request)
}

/// The options of both commands.
#[derive(Args)]
struct RequestArguments {
    /// The system [default: $SCL_SYSTEM, or the only one that runs, or that of ./topology.yaml].
    #[arg(long, value_name = "NAME")]
    system: Option<String>,
    #[command(flatten)]
    format: FormatArgument,
}

/// Asks, waits, prints what happened, and returns the exit code.
fn request(
    command: Command,
    components: &[String],
    build: bool,
    arguments: &RequestArguments,
) -> Result<ExitCode, Vec<Problem>> {
    let system = arguments.system.as_deref();
    let (here, named_after_here) = (&system_of_folder, &named_after_here);
    let done = ask(&ControlOptions { command, components, system, here, named_after_here, build })?;
    let reports = done.components;
    arguments.format.print(|| json!({ "components": reports }), || reports.iter().map(line).collect());
    print_problems(&done.problems);
    let all_done = done.problems.is_empty() && reports.iter().all(|report| report.done);
    Ok(if all_done { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn line(report: &ComponentReport) -> String {
    let ComponentReport { component, state, pid, detail, .. } = report;
    let process = pid.map(|pid| format!(" as process {pid}")).unwrap_or_default();
    // The detail describes the previous process.
    let detail = detail.as_deref().filter(|_| pid.is_none()).map(|detail| format!(": {}", escape(detail)));
    format!("{component}  {state}{process}{}\n", detail.unwrap_or_default())
}
