//! `scl diff`: what differs between two topologies, and which components that concerns.

mod change;
mod connections;
mod facts;
mod messages;
mod rebuild;
mod report;
mod revision;
mod together;

use crate::exit::COULD_NOT_DO;
use crate::load::{MaxSize, STDIN, TOPOLOGY, load_file, request, show_errors};
use change::find_changes;
use clap::{Args, ValueEnum};
use messages::find_message_changes;
use rebuild::find_rebuilds;
use report::{report_json, report_text};
use revision::Revision;
use scl_loader::{Loaded, Request, load};
use scl_plan::SystemPlan;
use scl_terminal::{Problem, print_out};
use scl_topology::topology::Topology;
use std::path::PathBuf;
use std::process::ExitCode;
use together::group;

/// Compare two topologies, and name the components that must be rebuilt.
///
/// Positions, comments, order and spelling do not count, only what the files mean. A component must be rebuilt if its
/// plan differs (see `scl plan`): its gates, their options, its connections, and their contracts. Components are
/// rebuilt together if a connection between them differs in its contract, or is new or gone, or if a message that they
/// exchange differs in a way that keeps them from understanding each other: one that was not rebuilt does not connect
/// to the others. Fields that are only new or gone are compatible and are not listed.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl diff HEAD                      what has changed in ./topology.yaml since the last commit
  scl diff main -- rover/topology.yaml
  scl diff v1.0..v1.1                two revisions
  scl diff old.yaml new.yaml         two files
  scl diff old.yaml new.yaml --format json                 one object

Exit code, like that of diff: 0 the same, 1 different, 2 a file or revision has errors or could not be read.")]
pub(crate) struct DiffArguments {
    /// The topology as it was; `-` is standard input. Without NEW, a git revision, or two with `..` between them.
    #[arg(value_name = "OLD|REVISION")]
    old: PathBuf,
    /// The topology as it is; `-` is standard input.
    #[arg(value_name = "NEW")]
    new: Option<PathBuf>,
    /// The file that is compared with its revision.
    #[arg(last = true, value_name = "FILE", default_value = TOPOLOGY, conflicts_with = "new")]
    file: PathBuf,
    /// The output format.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    #[command(flatten)]
    max_size: MaxSize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// One line per difference.
    Text,
    /// One JSON object.
    Json,
}

/// The body of `scl diff`.
pub(crate) fn diff(arguments: &DiffArguments) -> Result<ExitCode, Problem> {
    let (Some(old), Some(new)) = sides(arguments)? else { return Ok(ExitCode::from(COULD_NOT_DO)) };
    let (mut changes, rebuilds) = (find_changes(&old, &new), find_rebuilds(&old, &new));
    let messages = find_message_changes(&old, &new);
    let groups = group(&old, &new, messages.add_rebuilds(rebuilds, &new), &messages.pairs);
    changes.extend(messages.changes);
    let report = match arguments.format {
        Format::Text => report_text,
        Format::Json => report_json,
    };
    print_out(&report(&changes, &groups));
    Ok(ExitCode::from(u8::from(!changes.is_empty())))
}

/// One of the two topologies.
struct Side {
    topology: Topology,
    plan: SystemPlan,
    /// The system's name if the file gives one, else empty: a copy with another file name is still the same topology.
    system: String,
}

/// Returns both sides, or `None` for a side with errors. Both are read, so that the errors of both are reported.
fn sides(arguments: &DiffArguments) -> Result<(Option<Side>, Option<Side>), Problem> {
    let DiffArguments { old, new, file, max_size, .. } = arguments;
    if let Some(new) = new {
        if [old, new].iter().all(|file| file.as_os_str() == STDIN) {
            return Err(Problem::new("standard input can be read only once").help("name a file instead of one `-`"));
        }
        return Ok((side(load_file(old, *max_size)), side(load_file(new, *max_size))));
    }
    let name = old.to_string_lossy();
    let revision = |name: &str| {
        let name = if name.is_empty() { "HEAD" } else { name };
        let Revision { path, shown, .. } = &Revision::read(name, file)?;
        Ok::<_, Problem>(side(load(&Request { shown_as: shown.clone(), ..request(path, *max_size) })))
    };
    match name.split_once("..") {
        Some((old, new)) => Ok((revision(old)?, revision(new)?)),
        None => Ok((revision(&name)?, side(load_file(file, *max_size)))),
    }
}

fn side(loaded: Loaded) -> Option<Side> {
    if loaded.topology.is_none() {
        show_errors(&loaded);
    }
    let plan = loaded.system_plan();
    let system = loaded.model.system.map(|system| system.value).unwrap_or_default();
    loaded.topology.zip(plan).map(|(topology, plan)| Side { topology, plan, system })
}
