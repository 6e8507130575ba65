//! What `scl stop` and `scl restart` share: asking the `scl run` of the components, and showing what happened.

use crate::format::{FormatArgument, print_json};
use crate::load::{named_after_here, system_of_folder};
use clap::Args;
use scl_run::control::{Command, ComponentReport, Wish, ask};
use scl_terminal::{Problem, escape, print_err, print_out};
use serde_json::json;
use std::process::ExitCode;

/// Exit code: nothing was done.
const COULD_NOT_DO: u8 = 2;

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
    let system = arguments.system.as_deref();
    let (here, named_after_here) = (&system_of_folder, &named_after_here);
    let done = match ask(&Wish { command, components, system, here, named_after_here, build }) {
        Ok(done) => done,
        Err(problems) => {
            show(&problems);
            return ExitCode::from(COULD_NOT_DO);
        }
    };
    let reports = done.components;
    if arguments.format.is_json() {
        print_json(&json!({ "components": reports }));
    } else {
        print_out(&reports.iter().map(line).collect::<String>());
    }
    show(&done.problems);
    let all_done = done.problems.is_empty() && reports.iter().all(|report| report.done);
    if all_done { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn show(problems: &[Problem]) {
    problems.iter().for_each(|problem| print_err(&format!("{problem}\n")));
}

fn line(report: &ComponentReport) -> String {
    let ComponentReport { component, state, pid, detail, .. } = report;
    let process = pid.map(|pid| format!(" as process {pid}")).unwrap_or_default();
    // It tells of the process before.
    let detail = detail.as_deref().filter(|_| pid.is_none()).map(|detail| format!(": {}", escape(detail)));
    format!("{component}  {state}{process}{}\n", detail.unwrap_or_default())
}
