//! `scl list`: the components of a system, and whether they run.

use crate::format::{FormatArgument, print_json};
use crate::observed::SystemArgument;
use clap::Args;
use scl_observe::{Activity, Component, System, connected_peers};
use scl_terminal::{Align, Problem, Table, age_text, print_out};
use serde_json::{Value, json};
use std::process::ExitCode;
use std::time::SystemTime;

/// List the components of a running system: which run, since when, and in which process. If several systems run, all
/// are listed.
///
/// States: `running`; `waiting` (running, but required peers are not connected); `hangs` (running, but it has not
/// written its figures for some time); `dead` (killed or crashed); `stopped` (closed cleanly, or known only as the
/// peer of another component).
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl list
  scl list -v                                   with the gates
  scl list --system rover --format json | jq -r '.components[] | select(.state == \"dead\") | .name'

In JSON, several systems are an array `systems`.

Exit code: 0 listed, 2 there is no such system or none runs.")]
pub(crate) struct ListArguments {
    #[command(flatten)]
    system: SystemArgument,
    /// List the gates, too.
    #[arg(long, short)]
    verbose: bool,
    #[command(flatten)]
    format: FormatArgument,
}

/// The body of `scl list`.
pub(crate) fn list(arguments: &ListArguments) -> Result<ExitCode, Problem> {
    let (systems, now) = (System::find_all(arguments.system.name())?, SystemTime::now());
    if arguments.format.is_json() {
        let mut values: Vec<Value> = systems.iter().map(|system| to_json(system, &system.components(), now)).collect();
        print_json(&if values.len() == 1 { values.remove(0) } else { json!({"systems": values}) });
    } else {
        let texts = systems.iter().map(|system| to_text(system, arguments.verbose, now));
        print_out(&texts.collect::<Vec<_>>().join("\n"));
    }
    Ok(ExitCode::SUCCESS)
}

fn to_text(system: &System, verbose: bool, now: SystemTime) -> String {
    let components = system.components();
    let table = component_table(&components, now);
    let gates = if verbose { format!("\n{}", gate_table(&components)) } else { String::new() };
    format!("{}: {}\n\n{table}{gates}", system.name(), summary(&components))
}

fn to_json(system: &System, components: &[Component], now: SystemTime) -> Value {
    let component = |component: &Component| {
        let mut value = component.to_json(now);
        value["gates"] = (0..component.gates().len()).map(|gate| component.gate_to_json(gate, None)).collect();
        value
    };
    json!({"system": system.name(), "components": components.iter().map(component).collect::<Vec<_>>()})
}

/// `3 running, 1 dead, 1 stopped`
fn summary(components: &[Component]) -> String {
    let count = |word| (word, components.iter().filter(|component| component.state_word() == word).count());
    let counts = ["running", "dead", "stopped"].map(count).into_iter().filter(|(_, count)| *count > 0);
    let counts: Vec<String> = counts.map(|(word, count)| format!("{count} {word}")).collect();
    if counts.is_empty() { "no components".to_owned() } else { counts.join(", ") }
}

fn component_table(components: &[Component], now: SystemTime) -> String {
    let (left, right) = (Align::Left, Align::Right);
    let mut table =
        Table::new([("COMPONENT", left), ("STATE", left), ("PID", right), ("FOR", left), ("PROGRAM", left)]);
    for component in components {
        let announcement = component.announcement.as_ref();
        let started = announcement.filter(|_| component.is_running()).map(|it| it.started);
        let program =
            announcement.and_then(|it| it.program.file_name()).map(|name| name.to_string_lossy().into_owned());
        let program = component.host().map(|host| format!("on host {}", scl_terminal::escape(host))).or(program);
        table.row([
            component.name.clone(),
            state_word(component, now).to_owned(),
            component.process_id().map(|id| id.to_string()).unwrap_or_default(),
            started.map(|started| age_text(now.duration_since(started).unwrap_or_default())).unwrap_or_default(),
            program.unwrap_or_default(),
        ]);
    }
    table.text()
}

/// Returns the state of a component, and if it hangs, for how long.
pub(crate) fn state_text(component: &Component, now: SystemTime) -> String {
    match component.silent_for(now) {
        Some(silence) => format!("hangs for {}", age_text(silence)),
        None => state_word(component, now).to_owned(),
    }
}

/// Returns the state in one word, so that scripts can split the lines.
fn state_word(component: &Component, now: SystemTime) -> &'static str {
    match component.activity(now) {
        Activity::Ready => "running",
        activity => activity.word(),
    }
}

fn gate_table(components: &[Component]) -> String {
    let mut table = Table::with_headings(&["GATE", "KIND", "TYPE", "CODEC"], &["PEERS"]);
    for component in components.iter().filter(|component| component.is_running()) {
        for (index, gate) in component.gates().iter().enumerate() {
            let connected = connected_peers(gate, component.figures(index));
            let connected = connected.map_or_else(|| "?".to_owned(), |count| count.to_string());
            table.row([
                format!("{}.{}", component.name, gate.name),
                gate.kind.word().to_owned(),
                gate.payload.to_string(),
                gate.codec.clone(),
                format!("{connected}/{}", gate.connections.len()),
            ]);
        }
    }
    table.text()
}
