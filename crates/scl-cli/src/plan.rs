//! `scl plan`: the plans of a system's components as JSON.

use crate::load::{MaxSize, load_file, unsound};
use clap::Args;
use scl_plan::SystemPlan;
use scl_terminal::{print_err, print_out};
use std::path::PathBuf;
use std::process::ExitCode;

/// Maximum number of components that an error lists.
const LISTED: usize = 10;

/// Print the plan of a system as JSON: for each component everything its program needs to run.
///
/// That is its gates with kind, type, codec, options, and every connection with its peer, socket and contract, and the
/// protobuf messages as a descriptor set. Programs in other languages and `scl::untyped` open components from this
/// text; no program needs the topology file to run. Readers refuse a plan of another version of the format.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl plan > plan.json                        all components of ./topology.yaml
  scl plan rover.yaml --component sensor      one component
  scl plan | jq -r '.components[].gates[] | .contract'

Exit code: 0 printed, 1 the topology has errors or no such component, 2 the file could not be read.")]
pub(crate) struct PlanArguments {
    /// The topology file; `-` is standard input.
    #[arg(default_value = "topology.yaml")]
    file: PathBuf,
    /// Print the plan of this component only, or those of the components of this kind.
    #[arg(long, value_name = "NAME")]
    component: Option<String>,
    #[command(flatten)]
    max_size: MaxSize,
}

/// The body of `scl plan`.
pub(crate) fn plan(arguments: &PlanArguments) -> ExitCode {
    let loaded = load_file(&arguments.file, arguments.max_size);
    let Some(system) = loaded.system_plan() else { return unsound(&loaded) };
    let text = match &arguments.component {
        None => system.to_json(),
        Some(name) => match system.part(name) {
            Ok(part) => part.to_json(),
            Err(error) => {
                print_err(&format!("error: {error}\n{}", listed(&system)));
                return ExitCode::FAILURE;
            }
        },
    };
    print_out(&text);
    ExitCode::SUCCESS
}

/// The first components of a system, as a note.
fn listed(system: &SystemPlan) -> String {
    let names: Vec<_> = system.components.iter().take(LISTED).map(|plan| format!("`{}`", plan.component)).collect();
    match system.components.len() {
        0 => "  = note: it has no components\n".to_owned(),
        count @ 1..=LISTED => format!("  = note: its {count} components: {}\n", names.join(", ")),
        count => format!("  = note: its {count} components: {}, ...\n", names.join(", ")),
    }
}
