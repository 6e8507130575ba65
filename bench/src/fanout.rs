//! One publisher and eight subscribers, one of which is stopped from time to time: how it affects the other seven.

mod message;
mod publisher;
mod subscriber;

pub(crate) use subscriber::run_subscriber;

use crate::durations::Durations;
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::variant::Variant;
use message::{BATCH, BYTES, PERIOD};
use publisher::{Publisher, SUBSCRIBERS};
use std::time::Duration;

const ZEROMQ: &str = "zeromq PUB";

const VARIANTS: [Variant; 2] =
    [Variant { id: "scl", name: "SCL", baselines: &[ZEROMQ] }, Variant { id: "zeromq", name: ZEROMQ, baselines: &[] }];

const ALL_RUN: &str = "all run";
const ONE_STOPPED: &str = "one stopped";

/// The measurements of a variant, while all subscribers ran and while one was stopped.
struct Measurement {
    all_run: Phase,
    one_stopped: Phase,
    /// Number of messages that the stopped subscriber still received, for each time that it resumed.
    late_messages: Vec<usize>,
    /// The longest delay of those messages, in nanoseconds.
    oldest: u64,
}

struct Phase {
    delays: Durations,
    /// The time that each send took.
    sends: Durations,
    /// Number of messages not received, summed over the seven subscribers.
    lost: u64,
}

/// Measures the delay to seven of eight subscribers while the eighth one runs, and while it is stopped.
/// Each phase takes this time, at 1000 messages per second.
pub(crate) fn measure_fanout(time: Duration) -> scl::Result<Report> {
    let folder = ScratchFolder::new()?;
    let messages = u32::try_from(time.as_millis() / PERIOD.as_millis())?.max(1);
    let mut measurements = VARIANTS.iter().map(|_| Measurement::new()).collect::<scl::Result<Vec<_>>>()?;
    start_runtime()?.block_on(run(&folder.path, messages, &mut measurements))?;
    Ok(report(&measurements))
}

async fn run(folder: &str, messages: u32, measurements: &mut [Measurement]) -> scl::Result<()> {
    let mut publishers = Vec::new();
    for variant in &VARIANTS {
        publishers.push(Publisher::start(variant.id, folder).await?);
    }
    let batch = BATCH.min(messages);
    for _ in 0..messages.div_ceil(batch) {
        for (publisher, measurement) in publishers.iter_mut().zip(&mut *measurements) {
            measurement.all_run.run(publisher, batch).await?;
            publisher.stop_one().await?;
            measurement.one_stopped.run(publisher, batch).await?;
            measurement.record_late(&publisher.resume_one().await?);
        }
    }
    Ok(())
}

impl Measurement {
    fn new() -> scl::Result<Self> {
        Ok(Self { all_run: Phase::new()?, one_stopped: Phase::new()?, late_messages: Vec::new(), oldest: 0 })
    }

    fn record_late(&mut self, delays: &[u64]) {
        self.late_messages.push(delays.len());
        self.oldest = delays.iter().copied().fold(self.oldest, u64::max);
    }
}

impl Phase {
    fn new() -> scl::Result<Self> {
        Ok(Self { delays: Durations::new()?, sends: Durations::new()?, lost: 0 })
    }

    async fn run(&mut self, publisher: &mut Publisher, messages: u32) -> scl::Result<()> {
        publisher.send_batch(messages, &mut self.sends).await?;
        for delays in publisher.delays_of_others().await? {
            self.lost += u64::from(messages).saturating_sub(delays.len() as u64);
            delays.into_iter().for_each(|delay| self.delays.record(delay));
        }
        Ok(())
    }
}

fn report(measurements: &[Measurement]) -> Report {
    let mut columns = vec![Column::compared("p50_us"), Column::compared("p99_us"), Column::compared("max_us")];
    let mut sends = Table::new(format!("time of one send to all {SUBSCRIBERS} subscribers"), &columns);
    columns.push(Column::plain("lost"));
    let running = SUBSCRIBERS - 1;
    let title =
        format!("delay of {BYTES} bytes at 1000 Hz to {running} subscribers, the eighth one running or stopped");
    let mut delays = Table::new(title, &columns);
    for (variant, measurement) in VARIANTS.iter().zip(measurements) {
        for (phase, Phase { delays: own_delays, sends: own_sends, lost }) in
            [(ALL_RUN, &measurement.all_run), (ONE_STOPPED, &measurement.one_stopped)]
        {
            let row_in = |name: &str| format!("{name}, {phase}");
            let mut baselines = Vec::new();
            if phase == ONE_STOPPED {
                baselines.push(format!("{}, {ALL_RUN}", variant.name));
            }
            sends.rows.push(row(&row_in(variant.name), own_sends, &[]).with_baselines(&baselines));
            baselines.extend(variant.baselines.iter().map(|name| row_in(name)));
            delays.rows.push(row(&row_in(variant.name), own_delays, &[*lost as f64]).with_baselines(&baselines));
        }
    }
    let mut report = Report::new("fanout");
    report.tables.push(delays);
    report.tables.push(sends);
    report.tables.push(late_messages(measurements));
    report.note("a send of `zeromq` only queues the message; a send of SCL writes to all eight sockets");
    report
}

fn late_messages(measurements: &[Measurement]) -> Table {
    let columns = [Column::plain("messages"), Column::plain("oldest_ms")];
    let title = format!("what the stopped subscriber receives after it resumes, of up to {BATCH} messages");
    let mut table = Table::new(title, &columns);
    for (variant, Measurement { late_messages, oldest, .. }) in VARIANTS.iter().zip(measurements) {
        let mean = late_messages.iter().sum::<usize>() as f64 / late_messages.len().max(1) as f64;
        table.rows.push(Row::new(variant.name, vec![mean, *oldest as f64 / 1e6]));
    }
    table
}

fn row(name: &str, durations: &Durations, more: &[f64]) -> Row {
    let values = [&[durations.quantile(0.5), durations.quantile(0.99), durations.max()], more].concat();
    Row::new(name, values).with_durations(durations)
}
