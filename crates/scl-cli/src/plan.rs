//! `scl plan`: the plans of a system's components as JSON, and what their gates may hold.

mod memory;

use crate::format::{FormatArgument, OutputFormat};
use crate::load::{MaxSize, load_file, unsound};
use clap::Args;
use scl_plan::SystemPlan;
use scl_terminal::{print_err, print_out};
use scl_topology::topology::ComponentId;
use std::collections::HashSet;
use std::path::PathBuf;
use std::process::ExitCode;

/// Maximum number of components that an error lists.
const LISTED: usize = 10;

/// Print the plan of a system as JSON: for each component everything its program needs to run.
///
/// That is its gates with kind, type, codec, options, and every connection with its peer, socket and contract, and the
/// protobuf messages as a descriptor set. Programs in other languages and `scl::untyped` open components from this
/// text; no program needs the topology file to run. Readers refuse a plan of another version of the format.
///
/// With `--memory`, print how much memory the messages in the gates of each component may take at most.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl plan > plan.json                        all components of ./topology.yaml
  scl plan rover.yaml --component sensor      one component
  scl plan | jq -r '.components[].gates[] | .contract'
  scl plan --memory                           what the messages in its gates may take, as a table
  scl plan --memory --format json             the same in bytes

Exit code: 0 printed, 1 the topology has errors or no such component, 2 the file could not be read.")]
pub(crate) struct PlanArguments {
    /// The topology file; `-` is standard input.
    #[arg(default_value = "topology.yaml")]
    file: PathBuf,
    /// Print the plan of this component only, or those of the components of this kind.
    #[arg(long, value_name = "NAME")]
    component: Option<String>,
    /// Print the most that SCL holds in memory for each gate: messages that wait or are on their way.
    #[arg(long)]
    memory: bool,
    /// How to print that.
    #[arg(long, value_enum, default_value_t = OutputFormat::Text, value_name = "FORMAT", requires = "memory")]
    format: OutputFormat,
    #[command(flatten)]
    max_size: MaxSize,
}

/// The body of `scl plan`.
pub(crate) fn plan(arguments: &PlanArguments) -> ExitCode {
    let loaded = load_file(&arguments.file, arguments.max_size);
    let Some(system) = loaded.system_plan() else { return unsound(&loaded) };
    let part = match arguments.component.as_deref().map(|name| system.part(name)).transpose() {
        Ok(part) => part,
        Err(error) => {
            print_err(&format!("error: {error}\n{}", listed(&system)));
            return ExitCode::FAILURE;
        }
    };
    let system = part.as_ref().unwrap_or(&system);
    match &loaded.topology {
        Some(topology) if arguments.memory => {
            let names: HashSet<&str> = system.components.iter().map(|plan| plan.component.as_str()).collect();
            let components = topology.components().filter(|(_, component)| names.contains(component.name()));
            let components: Vec<ComponentId> = components.map(|(id, _)| id).collect();
            memory::print(topology, &components, FormatArgument { format: arguments.format });
        }
        _ => print_out(&system.to_json()),
    }
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
