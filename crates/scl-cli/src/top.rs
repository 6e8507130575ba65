//! `scl top`: the components and gates of a running system.

#[cfg(feature = "tui")]
mod draw;
#[cfg(feature = "tui")]
mod live;
mod rows;
#[cfg(feature = "tui")]
mod screen;
#[cfg(feature = "tui")]
mod view;

use crate::format::{FormatArgument, print_json};
use crate::observed::SystemArgument;
use clap::{Args, ValueEnum};
use rows::{
    COMPONENT_COLUMNS, GATE_COLUMNS, TEXT_COLUMNS, component_cells, gate_cells, parameter_cells, sort, to_json,
};
use scl_observe::{Snapshot, System, Watch};
use scl_terminal::{Problem, Table, escape, parse_duration, print_out};
use serde_json::json;
use std::process::ExitCode;
use std::thread;
use std::time::Duration;

/// The shortest period: figures are written twice a second.
const SHORTEST_PERIOD: Duration = Duration::from_millis(100);

/// Show the components and gates of a running system, live.
///
/// Everything is read from the files that components write twice a second, and from /proc, so watching costs them
/// nothing. If several systems run, all are shown. Keys: q ends, arrows choose a gate, Enter shows its connections, s
/// changes the order, space pauses. Live parameters are shown with the connections.
#[derive(Args)]
#[command(after_help = "\
Columns: CPU is the share of one processor, MEM the resident memory, RATE the messages per second (each counted once
for all peers), SENT counts a message once for each peer, WAIT those that wait in the program, DROP those dropped
because a queue was full (not those that a newer one has replaced in a `queue: 1`), LOST those on their way when a
connection broke, PEERS how many of all peers are connected.

Examples:
  scl top
  scl top --sort rate
  scl top --once                        a table, for a pipe or a report
  scl top --once --format json --period 10s

Exit code: 0 shown, 2 no such system, or no terminal.")]
pub(crate) struct TopArguments {
    /// Print one table and exit.
    #[arg(long)]
    once: bool,
    #[command(flatten)]
    system: SystemArgument,
    /// The time between two updates, over which rates and processor time are measured.
    #[arg(long, value_name = "DURATION", default_value = "1s", value_parser = parse_duration)]
    period: Duration,
    /// The order of the rows.
    #[arg(long, value_enum, default_value_t = Order::Name)]
    sort: Order,
    #[command(flatten)]
    format: FormatArgument,
}

/// What rows are sorted by. Where it does not apply, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Order {
    /// Components by name, gates as in the topology file.
    Name,
    /// Components by processor time.
    Cpu,
    /// Components by memory.
    Memory,
    /// Gates by messages per second.
    Rate,
    /// Gates by waiting messages.
    Waiting,
    /// Gates by dropped messages.
    Dropped,
}

/// The body of `scl top`.
pub(crate) fn top(arguments: &TopArguments) -> Result<ExitCode, Problem> {
    let period = arguments.period.max(SHORTEST_PERIOD);
    let mut watches: Vec<Watch> = System::find_all(arguments.system.name())?.into_iter().map(Watch::new).collect();
    if arguments.once {
        watches.iter_mut().for_each(|watch| drop(watch.look()));
        thread::sleep(period);
        let mut snapshots: Vec<Snapshot> = watches.iter_mut().map(Watch::look).collect();
        snapshots.iter_mut().for_each(|snapshot| sort(snapshot, arguments.sort));
        print_once(&snapshots, arguments.format.is_json());
        return Ok(ExitCode::SUCCESS);
    }
    if arguments.format.is_json() {
        return Err(Problem::new("the live display has no other format").help("add `--once`"));
    }
    live(watches, period, arguments.sort)
}

#[cfg(feature = "tui")]
fn live(watches: Vec<Watch>, period: Duration, order: Order) -> Result<ExitCode, Problem> {
    live::run(watches, period, order)
}

#[cfg(not(feature = "tui"))]
fn live(_watches: Vec<Watch>, _period: Duration, _order: Order) -> Result<ExitCode, Problem> {
    Err(Problem::new("this `scl` was built without the live display")
        .help("add `--once`, or build with `--features tui`"))
}

fn print_once(snapshots: &[Snapshot], is_json: bool) {
    match (snapshots, is_json) {
        ([only], true) => print_json(&to_json(only)),
        ([only], false) => print_out(&table(only)),
        (several, true) => print_json(&json!({"systems": several.iter().map(to_json).collect::<Vec<_>>()})),
        (several, false) => {
            let texts = several.iter().map(|it| format!("{}:\n{}", escape(&it.system), table(it)));
            print_out(&texts.collect::<Vec<_>>().join("\n"));
        }
    }
}

fn table(snapshot: &Snapshot) -> String {
    let mut components = empty_table(&COMPONENT_COLUMNS);
    snapshot.components.iter().for_each(|row| components.row(component_cells(row)));
    let mut gates = empty_table(&GATE_COLUMNS);
    snapshot.gates.iter().for_each(|row| gates.row(gate_cells(row)));
    let mut text = components.text();
    if !gates.is_empty() {
        text.push('\n');
        text.push_str(&gates.text());
    }
    let mut parameters = empty_table(&["PARAMETER", "VALUE"]);
    snapshot.components.iter().flat_map(parameter_cells).for_each(|row| parameters.row(row));
    if !parameters.is_empty() {
        text.push('\n');
        text.push_str(&parameters.text());
    }
    text
}

fn empty_table(headings: &[&str]) -> Table {
    let (texts, numbers) = headings.split_at(TEXT_COLUMNS);
    Table::with_headings(texts, numbers)
}
