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

/// The greatest SCL delay, idle and in the other situations.
type Maxima = Vec<f64>;

/// Measures the delay of every way, beside each other, in three situations; the last one only if it is permitted.
///
/// # Errors
///
/// The folder for temporary files cannot be used, a process cannot be started, or a connection fails.
pub fn measure_delay(options: &Delay) -> scl::Result<Report> {
    let mut report = Report::new("delay");
    let mut maxima = Maxima::new();
    report.add(measure_situation("idle", &[], options, &mut maxima)?);
    let _load = Load::start()?;
    report.add(measure_situation("under load", &[], options, &mut maxima)?);
    match real_time_refusal() {
        None => report.add(measure_situation("under load, real-time priority", &REAL_TIME, options, &mut maxima)?),
        Some(reason) => report.note(reason),
    }
    if let [idle, load, rest @ ..] = maxima.as_slice() {
        report.note(format!("under load the greatest delay of SCL is {:.1} times the idle one", load / idle));
        for real_time in rest {
            report.note(format!("with real-time priority it is {:.1} times the idle one", real_time / idle));
        }
    }
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

fn measure_situation(situation: &str, starter: &[&str], options: &Delay, maxima: &mut Maxima) -> scl::Result<Table> {
    let folder = scratch_folder()?;
    let messages = usize::try_from(options.time.as_millis() / PERIOD.as_millis())?.max(1);
    let batch = BATCH.min(messages);
    let words = ["delay", as_text(folder.path())?, &batch.to_string(), &messages.div_ceil(batch).to_string()];
    let mut source = OtherProcess::start_through(starter, &words)?;
    let mut all = WAYS.iter().map(|_| Times::new()).collect::<scl::Result<Vec<Times>>>()?;
    start_runtime()?.block_on(listen(&mut source, messages.div_ceil(batch), &mut all))?;
    maxima.extend(all.first().map(Times::greatest));
    Ok(table(situation, &all))
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

fn table(situation: &str, all: &[Times]) -> Table {
    let mut table =
        Table::new(format!("delay of {BYTES} bytes at 1000 Hz between two processes, {situation}"), &COLUMNS);
    for (way, times) in WAYS.iter().zip(all) {
        let figures = vec![times.least(), times.quantile(0.5), times.mean(), times.greatest(), times.variance()];
        table.add(Row::new(way.name, figures).beside_all(way.beside).with_times(times));
    }
    table
}
