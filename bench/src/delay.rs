//! The delay of a steady stream, idle, under load, and under load with real-time priority: Table III of the paper, whose
//! processes exchanged 20 bytes at 1000 Hz.

mod load;
mod source;

pub(crate) use source::play_source;

use crate::histogram::Times;
use crate::one_way::{RAW_PUBLISH, Received, SCL_PUBLISH, UNIX, Way};
use crate::processes::{OtherProcess, as_text, scratch_folder, start_runtime};
use crate::report::{Column, Report, Row, Table};
use load::Load;
use std::process::{Command, Stdio};
use std::time::Duration;

const WAYS: [&Way; 3] = [&SCL_PUBLISH, &RAW_PUBLISH, &UNIX];

const BYTES: usize = 20;
const PERIOD: Duration = Duration::from_millis(1);
/// Messages of one way before it is the next one's turn.
const BATCH: usize = 200;

/// Starts a program with real-time priority; comes with util-linux and busybox.
const REAL_TIME: [&str; 3] = ["chrt", "-f", "80"];

const COLUMNS: [Column; 5] = [
    Column::plain("min_us"),
    Column::compared("p50_us"),
    Column::plain("mean_us"),
    Column::compared("max_us"),
    Column::plain("variance_us2"),
];

/// What [`measure_delay`] is asked for.
#[derive(Debug, Clone)]
pub struct Delay {
    /// How long each way is measured in each situation; at 1000 messages a second.
    pub time: Duration,
}

/// What stands in the names of the rows, and the program that starts the processes.
struct Situation {
    name: &'static str,
    starter: &'static [&'static str],
}

const IDLE: Situation = Situation { name: "idle", starter: &[] };
const LOAD: Situation = Situation { name: "load", starter: &[] };
const REAL_TIME_LOAD: Situation = Situation { name: "load, real-time", starter: &REAL_TIME };

/// Measures the delay of every way, beside each other, in three situations; the last one only if it is permitted.
///
/// # Errors
///
/// The folder for temporary files cannot be used, a process cannot be started, or a connection fails.
pub fn measure_delay(options: &Delay) -> scl::Result<Report> {
    let mut table = Table::new(format!("delay of {BYTES} bytes at 1000 Hz between two processes"), &COLUMNS);
    let mut report = Report::new("delay");
    measure_situation(&IDLE, options, &mut table)?;
    let _load = Load::start()?;
    measure_situation(&LOAD, options, &mut table)?;
    match real_time_refusal() {
        None => measure_situation(&REAL_TIME_LOAD, options, &mut table)?,
        Some(reason) => report.note(reason),
    }
    report.add(table);
    report.note(
        "the paper's greatest delay was 7.7 times the idle one under load, and 1.6 times with real-time priority",
    );
    Ok(report)
}

/// Why nothing can be measured with real-time priority here.
fn real_time_refusal() -> Option<String> {
    let [chrt, rest @ ..] = REAL_TIME;
    let mut attempt = Command::new(chrt);
    attempt.args(rest).arg("true").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    match attempt.status() {
        Ok(status) if status.success() => None,
        Ok(_) => Some(
            "real-time priority is not permitted here: run as root, or raise the limit `rtprio` (`ulimit -r 80`)"
                .to_owned(),
        ),
        Err(error) => {
            Some(format!("real-time priority was not tried: the program `{chrt}` cannot be started: {error}"))
        }
    }
}

fn measure_situation(situation: &Situation, options: &Delay, table: &mut Table) -> scl::Result<()> {
    let folder = scratch_folder()?;
    let messages = usize::try_from(options.time.as_millis() / PERIOD.as_millis())?.max(1);
    let batch = BATCH.min(messages);
    let words = ["delay", as_text(folder.path())?, &batch.to_string(), &messages.div_ceil(batch).to_string()];
    let mut source = OtherProcess::start_through(situation.starter, &words)?;
    let mut all = WAYS.iter().map(|_| Times::new()).collect::<scl::Result<Vec<Times>>>()?;
    start_runtime()?.block_on(listen(&mut source, messages.div_ceil(batch), &mut all))?;
    for (way, times) in WAYS.iter().zip(&all) {
        table.add(row(way, situation, times));
    }
    Ok(())
}

async fn listen(source: &mut OtherProcess, rounds: usize, all: &mut [Times]) -> scl::Result<()> {
    for _ in 0..rounds {
        for times in &mut *all {
            let received = Received::parse(&source.line().await?)?;
            received.delays.iter().for_each(|delay| times.record(*delay));
        }
    }
    Ok(())
}

/// A row, beside the other ways in its situation, and beside the same way when idle.
fn row(way: &Way, situation: &Situation, times: &Times) -> Row {
    let figures = vec![times.least(), times.quantile(0.5), times.mean(), times.greatest(), times.variance()];
    let name_in = |name: &str, situation: &Situation| format!("{name}, {}", situation.name);
    let mut row = Row::new(name_in(way.name, situation), figures).with_times(times);
    for (label, other) in way.beside {
        row = row.beside(label, name_in(other, situation));
    }
    if situation.name == IDLE.name { row } else { row.beside("idle", name_in(way.name, &IDLE)) }
}
