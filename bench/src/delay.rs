//! The delay of a periodic stream: idle, under load, and under load with real-time priority. Table III of the paper,
//! whose processes exchanged 20 bytes at 1000 Hz.

mod load;
mod source;

pub(crate) use source::run_source;

use crate::durations::Durations;
use crate::one_way::{BatchReport, SCL_PUB, ZEROMQ_PUB};
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::variant::{UNIX, Variant};
use crate::worker::Worker;
use load::Load;
use std::process::{Command, Stdio};
use std::time::Duration;

const VARIANTS: [Variant; 3] = [SCL_PUB, ZEROMQ_PUB, UNIX];

const BYTES: usize = 20;
const PERIOD: Duration = Duration::from_millis(1);

/// Number of messages sent through one variant before the next variant has its turn.
const BATCH: usize = 200;

/// The command that starts a program with real-time priority; part of util-linux and busybox.
const REAL_TIME: [&str; 3] = ["chrt", "-f", "80"];

const COLUMNS: [Column; 5] = [
    Column::plain("min_us"),
    Column::compared("p50_us"),
    Column::plain("mean_us"),
    Column::compared("max_us"),
    Column::plain("variance_us2"),
];

/// A situation to measure in: its name, which is part of the names of rows, and the program that starts the processes.
#[derive(Clone, Copy)]
struct Situation {
    name: &'static str,
    launcher: &'static [&'static str],
}

const IDLE: Situation = Situation { name: "idle", launcher: &[] };
const LOAD: Situation = Situation { name: "load", launcher: &[] };
const REAL_TIME_LOAD: Situation = Situation { name: "real-time", launcher: &REAL_TIME };

/// Measures the delay of all variants in three situations, each for `time`. The last one is skipped unless real-time
/// priority is permitted.
pub(crate) fn measure_delay(time: Duration) -> scl::Result<Report> {
    let title = format!("delay of {BYTES} bytes at 1000 Hz: idle, under load, under load with real-time priority");
    let mut table = Table::new(title, &COLUMNS);
    let mut report = Report::new("delay");
    measure_situation(IDLE, time, &mut table)?;
    let _load = Load::start()?;
    measure_situation(LOAD, time, &mut table)?;
    match why_not_real_time() {
        None => measure_situation(REAL_TIME_LOAD, time, &mut table)?,
        Some(reason) => report.note(reason),
    }
    report.tables.push(table);
    report.note("in the paper, load raised the maximum 7.7 times, and 1.6 times with real-time priority");
    Ok(report)
}

/// Returns the reason why real-time priority cannot be used, or `None` if it can.
fn why_not_real_time() -> Option<String> {
    let [chrt, rest @ ..] = REAL_TIME;
    let mut attempt = Command::new(chrt);
    attempt.args(rest).arg("true").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    match attempt.status() {
        Ok(status) if status.success() => None,
        Ok(_) => {
            Some("real-time priority is not permitted: run as root, or raise `rtprio` (`ulimit -r 80`)".to_owned())
        }
        Err(error) => Some(format!("real-time priority was not measured: `{chrt}` does not start: {error}")),
    }
}

fn measure_situation(situation: Situation, time: Duration, table: &mut Table) -> scl::Result<()> {
    let folder = ScratchFolder::new()?;
    let messages = usize::try_from(time.as_millis() / PERIOD.as_millis())?.max(1);
    let batch = BATCH.min(messages);
    let rounds = messages.div_ceil(batch);
    let arguments = ["delay", &folder.path, &batch.to_string(), &rounds.to_string()];
    let mut source = Worker::start_with(situation.launcher, &arguments)?;
    let mut delays = VARIANTS.iter().map(|_| Durations::new()).collect::<scl::Result<Vec<_>>>()?;
    start_runtime()?.block_on(collect(&mut source, rounds, &mut delays))?;
    for (variant, delays) in VARIANTS.iter().zip(&delays) {
        table.rows.push(row(variant, situation, delays));
    }
    Ok(())
}

async fn collect(source: &mut Worker, rounds: usize, all: &mut [Durations]) -> scl::Result<()> {
    for _ in 0..rounds {
        for delays in &mut *all {
            let report = BatchReport::parse(&source.next_line().await?)?;
            report.delays.iter().for_each(|delay| delays.record(*delay));
        }
    }
    Ok(())
}

/// Makes the row of a variant. SCL is compared with the other variants in the same situation, and every variant with
/// itself when idle.
fn row(variant: &Variant, situation: Situation, delays: &Durations) -> Row {
    let name_in = |variant: &Variant, situation: Situation| format!("{}, {}", variant.name, situation.name);
    let mut baselines = Vec::new();
    if variant.id == SCL_PUB.id {
        baselines.extend([UNIX, ZEROMQ_PUB].map(|baseline| name_in(&baseline, situation)));
    }
    if situation.name != IDLE.name {
        baselines.push(name_in(variant, IDLE));
    }
    let values = vec![delays.min(), delays.quantile(0.5), delays.mean(), delays.max(), delays.variance()];
    Row::new(name_in(variant, situation), values).with_baselines(&baselines).with_durations(delays)
}
