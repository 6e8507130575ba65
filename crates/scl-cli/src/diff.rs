//! `scl diff`: what differs between two topologies, and which components that concerns.

mod change;
mod facts;
mod messages;
mod rebuild;
mod report;
mod together;

use crate::load::{MaxSize, STDIN, load_file, show_errors};
use change::find_changes;
use clap::{Args, ValueEnum};
use messages::find_message_changes;
use rebuild::find_rebuilds;
use report::{report_json, report_text};
use scl_plan::SystemPlan;
use scl_terminal::{print_err, print_out};
use scl_topology::topology::Topology;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use together::group;

/// Exit code: one of the two is not a sound topology.
const TROUBLE: u8 = 2;

/// Compare two topologies, and name the components that must be rebuilt.
///
/// Positions, comments, order and spelling do not count, only what the files mean. A component must be rebuilt if its plan
/// differs (see `scl plan`): its gates, their options, its connections, and their contracts. Components are rebuilt together
/// if a connection between them differs in its contract, or is new or gone, or if a message that they exchange differs in a
/// way that keeps them from understanding each other: one that is left as it was does not connect to the others. Fields
/// that are only new or gone are compatible and are not listed.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl diff old.yaml new.yaml
  git show main:topology.yaml | scl diff - topology.yaml   against another branch
  scl diff old.yaml new.yaml --format json                 one object

Exit code, as of diff: 0 the same, 1 different, 2 a file has errors or could not be read.")]
pub(crate) struct DiffArguments {
    /// The topology as it was; `-` is standard input.
    #[arg(value_name = "OLD")]
    old: PathBuf,
    /// The topology as it is; `-` is standard input.
    #[arg(value_name = "NEW")]
    new: PathBuf,
    /// How to say it.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    #[command(flatten)]
    max_size: MaxSize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// A line a difference.
    Text,
    /// One JSON object.
    Json,
}

/// The body of `scl diff`.
pub(crate) fn diff(arguments: &DiffArguments) -> ExitCode {
    if [&arguments.old, &arguments.new].iter().all(|file| file.as_os_str() == STDIN) {
        print_err("error: standard input can be read only once\n  = help: name a file instead of one `-`\n");
        return ExitCode::from(TROUBLE);
    }
    // Both are read, so that the problems of both are told.
    let (old, new) = (read(&arguments.old, arguments), read(&arguments.new, arguments));
    let (Some(old), Some(new)) = (old, new) else { return ExitCode::from(TROUBLE) };
    let (mut changes, rebuilds) = (find_changes(&old, &new), find_rebuilds(&old, &new));
    let messages = find_message_changes(&old, &new);
    let groups = group(&old, &new, messages.add_rebuilds(rebuilds, &new), &messages.pairs);
    changes.extend(messages.changes);
    let report = match arguments.format {
        Format::Text => report_text,
        Format::Json => report_json,
    };
    print_out(&report(&changes, &groups));
    ExitCode::from(u8::from(!changes.is_empty()))
}

/// One of the two topologies.
struct Side {
    topology: Topology,
    plan: SystemPlan,
    /// The system's name if the file gives one, else empty: a copy with another file name is still the same topology.
    system: String,
}

fn read(path: &Path, arguments: &DiffArguments) -> Option<Side> {
    let loaded = load_file(path, arguments.max_size);
    if loaded.topology.is_none() {
        show_errors(&loaded);
    }
    let plan = loaded.system_plan();
    let system = loaded.model.system.map(|system| system.value).unwrap_or_default();
    loaded.topology.zip(plan).map(|(topology, plan)| Side { topology, plan, system })
}
