//! What `scl stop` and `scl restart` share: asking the `scl run` of the components, and showing what happened.

use crate::exit::{exit_code_of_all, print_problems};
use crate::format::FormatArgument;
use crate::load::{named_after_here, system_of_folder};
use clap::Args;
use scl_run::control::{Command, ComponentReport, Wish, ask};
use scl_terminal::{Problem, escape};
use serde_json::json;
use std::process::ExitCode;

/// The options of both commands.
#[derive(Args)]
pub(crate) struct RequestArguments {
    /// The system [default: $SCL_SYSTEM, or the only one that runs, or that of ./topology.yaml].
    #[arg(long, value_name = "NAME")]
    system: Option<String>,
    #[command(flatten)]
    format: FormatArgument,
}

/// Asks, waits, prints what happened, and returns the exit code.
pub(crate) fn request(command: Command, components: &[String], build: bool, arguments: &RequestArguments) -> ExitCode {
    exit_code_of_all(ask_and_print(command, components, build, arguments))
}

fn ask_and_print(
    command: Command,
    components: &[String],
    build: bool,
    arguments: &RequestArguments,
) -> Result<ExitCode, Vec<Problem>> {
    let system = arguments.system.as_deref();
    let (here, named_after_here) = (&system_of_folder, &named_after_here);
    let done = ask(&Wish { command, components, system, here, named_after_here, build })?;
    let reports = done.components;
    arguments.format.print(|| json!({ "components": reports }), || reports.iter().map(line).collect());
    print_problems(&done.problems);
    let all_done = done.problems.is_empty() && reports.iter().all(|report| report.done);
    Ok(if all_done { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn line(report: &ComponentReport) -> String {
    let ComponentReport { component, state, pid, detail, .. } = report;
    let process = pid.map(|pid| format!(" as process {pid}")).unwrap_or_default();
    // It tells of the process before.
    let detail = detail.as_deref().filter(|_| pid.is_none()).map(|detail| format!(": {}", escape(detail)));
    format!("{component}  {state}{process}{}\n", detail.unwrap_or_default())
}
