//! What `scl hz`, `scl delay` and `scl bw` share: a line for each gate and second, and a summary at the end.

use crate::format::FormatArgument;
use crate::observed::SystemArgument;
use clap::Args;
use scl_observe::{GateReport, Measurement, Meter, ObservedGate, StopSignals, System, at_taps};
use scl_terminal::{
    Problem, escape_json, output_is_closed, output_width, parse_duration, print_err, print_out, quoted_list, shorten,
};
use serde_json::{Map, Value, json};
use std::process::ExitCode;
use std::time::Duration;
use tokio::time::{Instant, MissedTickBehavior, interval_at, sleep};

/// How often a line is printed, and how long `--once` measures.
const INTERVAL: Duration = Duration::from_secs(1);

/// After how many lines of a single gate the header is repeated.
const PAGE: usize = 20;

/// Between two columns.
const GAP: &str = "  ";

/// A shortened name keeps at least this width.
const SHORTEST_NAME: usize = 8;

#[derive(Args)]
pub(crate) struct MeasureArguments {
    /// Measure for this long and end with a summary: `10s` [default: until Ctrl-C].
    #[arg(long = "for", value_name = "DURATION", value_parser = parse_duration)]
    duration: Option<Duration>,
    /// Print only the summary, of one second or of the duration of `--for`.
    #[arg(long)]
    once: bool,
    #[command(flatten)]
    system: SystemArgument,
    #[command(flatten)]
    format: FormatArgument,
}

/// How the figures of a meter are shown.
pub(crate) trait Shown: Meter {
    /// The headers of its columns, and their widths.
    const COLUMNS: &'static [(&'static str, usize)];

    /// The cells of a line; `None` without messages.
    fn cells(figures: &Self::Figures) -> Option<Vec<String>>;

    /// The figures as JSON.
    fn json(figures: &Self::Figures) -> Value;

    /// A remark to print below the summary, if one is needed.
    fn remark(_figures: &Self::Figures) -> Option<String> {
        None
    }
}

/// Measures these gates, or all if `gates` is empty, until the requested time is over or a stop request arrives.
pub(crate) async fn measure<M: Shown + 'static>(
    arguments: &MeasureArguments,
    gates: &[String],
    new_meter: impl Fn() -> M + 'static,
) -> Result<ExitCode, Problem> {
    let mut stop = StopSignals::watch()?;
    let system = System::find(arguments.system.name())?;
    let mut measurement = if gates.is_empty() {
        Measurement::of_all(&system, new_meter)
    } else {
        let gates = gates.iter().map(|gate| system.gate(gate)).collect::<Result<Vec<_>, _>>()?;
        for gate in gates.iter().filter(|gate| gate.taps.first().is_some_and(|tap| tap.component != gate.component)) {
            let senders = at_taps(std::slice::from_ref(gate));
            let senders: Vec<_> = senders.iter().map(ObservedGate::name).collect();
            let senders = quoted_list(&senders);
            print_err(&format!("note: `{}` is measured where its messages come from: {senders}\n", gate.name()));
        }
        Measurement::of(&system, &gates, new_meter)
    };
    let mut output = Output { is_json: arguments.format.is_json(), several: gates.len() != 1, lines: 0 };
    let deadline = arguments.duration.or(arguments.once.then_some(INTERVAL));
    let until_deadline = async {
        match deadline {
            Some(duration) => sleep(duration).await,
            None => std::future::pending().await,
        }
    };
    tokio::pin!(until_deadline);
    let mut ticks = interval_at(Instant::now() + INTERVAL, INTERVAL);
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let interrupted = loop {
        tokio::select! {
            () = measurement.run() => {}
            () = stop.received() => break true,
            () = &mut until_deadline => break false,
            _ = ticks.tick(), if !arguments.once => {
                let reports = measurement.take_interval();
                output.print::<M>(&reports, false);
                if output_is_closed() {
                    return Ok(ExitCode::SUCCESS);
                }
            }
        }
    };
    let reports = measurement.total();
    output.print::<M>(&reports, true);
    let seen = reports.iter().any(|report| M::cells(&report.figures).is_some());
    Ok(if seen || interrupted { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Prints tables, whose columns keep their widths from line to line.
struct Output {
    is_json: bool,
    /// Whether lines begin with the name of a gate.
    several: bool,
    /// Number of intervals printed so far.
    lines: usize,
}

impl Output {
    fn print<M: Shown>(&mut self, reports: &[GateReport<M::Figures>], is_total: bool) {
        let text = if self.is_json {
            let lines = reports.iter().map(|report| format!("{}\n", to_json::<M>(report, is_total)));
            escape_json(&lines.collect::<String>()).into_owned()
        } else {
            self.table::<M>(reports, is_total)
        };
        print_out(&text);
    }

    fn table<M: Shown>(&mut self, reports: &[GateReport<M::Figures>], is_total: bool) -> String {
        if reports.is_empty() {
            return "no gates\n".to_owned();
        }
        let name_width = if self.several || is_total { name_width::<M>(reports) } else { 0 };
        let mut text = String::new();
        if self.lines > 0 && (self.several || is_total) {
            text.push('\n');
        }
        if self.lines > 0 && is_total {
            text.push_str("in total:\n");
        }
        if self.several || is_total || self.lines.is_multiple_of(PAGE) {
            let headers = M::COLUMNS.iter().map(|(header, _)| (*header).to_owned()).collect();
            text.push_str(&line::<M>(name_width, "GATE", headers));
        }
        self.lines += 1;
        for report in reports {
            let cells = M::cells(&report.figures).unwrap_or_else(|| vec![format!("no messages ({})", report.state)]);
            text.push_str(&line::<M>(name_width, &report.gate, cells));
        }
        if is_total {
            let remarks = reports.iter().filter_map(|report| M::remark(&report.figures));
            remarks.for_each(|remark| text.push_str(&format!("{remark}\n")));
        }
        text
    }
}

/// Returns the width of the column of names: that of the longest name, cut to what the figures leave of the terminal,
/// but not below `SHORTEST_NAME`.
fn name_width<M: Shown>(reports: &[GateReport<M::Figures>]) -> usize {
    let longest = reports.iter().map(|report| report.gate.len()).max().unwrap_or(0).max("GATE".len());
    let figures: usize = M::COLUMNS.iter().map(|(_, width)| GAP.len() + width).sum();
    longest.min(output_width().saturating_sub(figures).max(SHORTEST_NAME))
}

/// A line of a table: the name, unless its column has no width, and right-aligned cells.
fn line<M: Shown>(name_width: usize, name: &str, cells: Vec<String>) -> String {
    let mut line = format!("{:name_width$}", shorten(name, name_width));
    for (cell, (_, width)) in cells.iter().zip(M::COLUMNS) {
        line.push_str(if line.is_empty() { "" } else { GAP });
        line.push_str(&format!("{cell:>width$}"));
    }
    format!("{}\n", line.trim_end())
}

fn to_json<M: Shown>(report: &GateReport<M::Figures>, is_total: bool) -> Value {
    let mut object = Map::new();
    object.insert("gate".to_owned(), json!(report.gate));
    object.insert("total".to_owned(), json!(is_total));
    object.insert("state".to_owned(), json!(report.state));
    if let Value::Object(figures) = M::json(&report.figures) {
        object.extend(figures);
    }
    Value::Object(object)
}
