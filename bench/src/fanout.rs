//! One publisher and eight subscribers, one of which is stopped now and then: what the other seven notice of it.

mod components;
mod crowd;
mod message;
mod sink;

pub(crate) use sink::play_sink;

use crate::histogram::Times;
use crate::processes::{as_text, scratch_folder, start_runtime};
use crate::report::{Column, Others, Report, Row, Table};
use crowd::Crowd;
use message::BYTES;
use std::time::Duration;

/// All subscribers; the scenario's file has as many.
const SINKS: usize = 8;

const PERIOD: Duration = Duration::from_millis(1);

/// Messages before a subscriber is stopped or goes on: enough that what it does not read fills its socket, which takes
/// some 278 of them.
const BATCH: u32 = 1000;

/// A way in one of its two phases.
struct Phase {
    name: &'static str,
    /// Rows for delays to stand beside.
    delays_beside: Others,
    sends_beside: Others,
}

const SCL: &str = "SCL, all eight run";
const RAW: &str = "zeromq PUB, all eight run";
const SCL_STOPPED: &str = "SCL, one stopped";
const RAW_STOPPED: &str = "zeromq PUB, one stopped";

const SCL_PHASES: [Phase; 2] = [
    Phase { name: SCL, delays_beside: &[("zeromq", RAW)], sends_beside: &[] },
    Phase {
        name: SCL_STOPPED,
        delays_beside: &[("zeromq", RAW_STOPPED), ("all run", SCL)],
        sends_beside: &[("all run", SCL)],
    },
];

const RAW_PHASES: [Phase; 2] = [
    Phase { name: RAW, delays_beside: &[], sends_beside: &[] },
    Phase { name: RAW_STOPPED, delays_beside: &[("all run", RAW)], sends_beside: &[("all run", RAW)] },
];

/// A way: the word for it between the processes, its name, and its phases.
const WAYS: [(&str, &str, [Phase; 2]); 2] = [("scl", "SCL", SCL_PHASES), ("raw", "zeromq PUB", RAW_PHASES)];

/// What [`measure_fanout`] is asked for.
#[derive(Debug, Clone)]
pub struct Fanout {
    /// How long each way is measured in each phase; at 1000 messages a second.
    pub time: Duration,
}

/// What came of a way in one phase.
struct Measured {
    delays: Times,
    sends: Times,
    /// Messages that one of the seven did not get.
    lost: u64,
    /// Of each time that the eighth went on: what it still got of the messages that were sent meanwhile.
    late: Vec<usize>,
    /// The greatest delay of those, in nanoseconds.
    oldest: u64,
}

/// Measures the delay to seven of eight subscribers while the eighth runs and while it is stopped, in turn.
///
/// # Errors
///
/// The folder for temporary files cannot be used, a process cannot be started, or a connection fails.
pub fn measure_fanout(options: &Fanout) -> scl::Result<Report> {
    let folder = scratch_folder()?;
    let messages = u32::try_from(options.time.as_millis() / PERIOD.as_millis())?.max(1);
    let mut all = Vec::new();
    for _ in &WAYS {
        all.push([Measured::new()?, Measured::new()?]);
    }
    start_runtime()?.block_on(play(as_text(folder.path())?, messages, &mut all))?;
    Ok(report(&all))
}

async fn play(folder: &str, messages: u32, all: &mut [[Measured; 2]]) -> scl::Result<()> {
    let mut crowds = Vec::new();
    for (word, ..) in &WAYS {
        crowds.push(Crowd::start(word, folder).await?);
    }
    let batch = BATCH.min(messages);
    for _ in 0..messages.div_ceil(batch) {
        for (crowd, [running, stopped]) in crowds.iter_mut().zip(&mut *all) {
            crowd.play(batch, running).await?;
            crowd.stop_one().await?;
            crowd.play(batch, stopped).await?;
            stopped.catch_up(&crowd.let_it_go_on().await?);
        }
    }
    Ok(())
}

impl Measured {
    fn new() -> scl::Result<Self> {
        Ok(Self { delays: Times::new()?, sends: Times::new()?, lost: 0, late: Vec::new(), oldest: 0 })
    }

    fn catch_up(&mut self, delays: &[u64]) {
        self.late.push(delays.len());
        self.oldest = delays.iter().copied().fold(self.oldest, u64::max);
    }
}

fn report(all: &[[Measured; 2]]) -> Report {
    let mut columns = vec![Column::compared("p50_us"), Column::compared("p99_us"), Column::compared("max_us")];
    let mut sends = Table::new(format!("one send to all {SINKS}, in the publisher"), &columns);
    columns.push(Column::plain("lost"));
    let title = format!(
        "delay of {BYTES} bytes at 1000 Hz from one process to {} of {SINKS} others, the eighth stopped now and then",
        SINKS - 1
    );
    let mut delays = Table::new(title, &columns);
    let phases = WAYS.iter().flat_map(|(.., phases)| phases);
    for (phase, measured) in phases.zip(all.iter().flatten()) {
        delays.add(row(phase.name, &measured.delays, &[measured.lost as f64]).beside_all(phase.delays_beside));
        sends.add(row(phase.name, &measured.sends, &[]).beside_all(phase.sends_beside));
    }
    let mut report = Report::new("fanout");
    report.add(delays);
    report.add(sends);
    report.add(what_was_late(all));
    report
        .note("a `zeromq` PUB socket only queues what it is given, and writes to the eight later; SCL writes at once");
    report
}

fn what_was_late(all: &[[Measured; 2]]) -> Table {
    let columns = [Column::plain("messages"), Column::plain("oldest_ms")];
    let mut table = Table::new(
        format!("what the eighth still gets, when it goes on, of up to {BATCH} messages that it was stopped for"),
        &columns,
    );
    for ((_, name, _), [_, stopped]) in WAYS.iter().zip(all) {
        let messages = stopped.late.iter().sum::<usize>() as f64 / stopped.late.len().max(1) as f64;
        table.add(Row::new(*name, vec![messages, stopped.oldest as f64 / 1e6]));
    }
    table
}

fn row(name: &str, times: &Times, more: &[f64]) -> Row {
    let figures = [&[times.quantile(0.5), times.quantile(0.99), times.greatest()], more].concat();
    Row::new(name, figures).with_times(times)
}
