//! The age of the first value that a subscriber receives after it did not receive for a while.
//!
//! A control loop that was busy must not act on old values: with `queue: 1` the first value is to be the newest.

mod components;
mod publishers;
mod subscriber;

pub(crate) use subscriber::run_subscriber;

use crate::durations::Durations;
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::worker::Worker;
use publishers::Publishers;
use scl::time::interval;
use std::time::Duration;

const PERIOD: Duration = Duration::from_millis(1);

/// The size of a message: the time at which it was sent, padded to the size that the other benchmarks use.
const BYTES: usize = 20;

/// A way to receive: its name between the processes and in the report, and what it is compared with.
struct Variant {
    id: &'static str,
    name: &'static str,
    baselines: &'static [&'static str],
}

const LIBZMQ: &str = "libzmq SUB (ZMQ_CONFLATE)";
const ZEROMQ: &str = "zeromq SUB";

const VARIANTS: &[Variant] = &[
    Variant { id: "scl-recv", name: "SCL recv", baselines: &[LIBZMQ, ZEROMQ] },
    Variant { id: "scl-recv-polled", name: "SCL recv (polled)", baselines: &[LIBZMQ, ZEROMQ] },
    Variant { id: "scl-recv-blocking", name: "SCL recv_blocking", baselines: &[LIBZMQ, ZEROMQ] },
    Variant { id: "scl-latest", name: "SCL latest", baselines: &[LIBZMQ, ZEROMQ] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq", name: LIBZMQ, baselines: &[] },
    Variant { id: "zeromq", name: ZEROMQ, baselines: &[] },
];

const COLUMNS: [Column; 4] = [
    Column::compared("age_p50_periods"),
    Column::plain("age_max_periods"),
    Column::plain("call_p50_us"),
    Column::plain("call_max_us"),
];

/// Options of [`measure_fresh`].
#[derive(Debug, Clone)]
pub struct FreshOptions {
    /// How often each subscriber pauses.
    pub repetitions: usize,
    /// How long a subscriber does not receive.
    pub pause: Duration,
}

/// What was measured of a variant.
struct Measurement {
    /// From sending the first value after a pause to receiving it.
    ages: Durations,
    /// How long the call took that received it.
    calls: Durations,
    repetitions: usize,
}

/// Measures the age of the first value after a pause, at 1000 values per second.
///
/// All subscribers run at the same time, so that a repetition takes one pause.
///
/// # Errors
///
/// The folder for temporary files cannot be used, a process cannot be started, or a connection fails.
pub fn measure_fresh(options: &FreshOptions) -> scl::Result<Report> {
    let folder = ScratchFolder::new()?;
    let measurements = start_runtime()?.block_on(run(folder.path(), options))?;
    let mut report = Report::new("fresh");
    report.add(table(options, &measurements));
    report.note("one period is 1 ms; the newest value is at most about one period old");
    report.note("the pause blocks the thread, except in the line `polled`, where the runtime runs");
    Ok(report)
}

async fn run(folder: &str, options: &FreshOptions) -> scl::Result<Vec<Measurement>> {
    let mut publishers = Publishers::open(folder).await?;
    let [repetitions, pause] =
        [options.repetitions as u128, options.pause.as_micros()].map(|number| number.to_string());
    let mut subscribers = Vec::new();
    for (index, variant) in VARIANTS.iter().enumerate() {
        let arguments = ["fresh", variant.id, folder, &repetitions, &pause, &index.to_string()];
        subscribers.push((Worker::start(&arguments)?, Measurement::new()?));
    }
    publishers.ready().await?;
    let mut interval = interval(PERIOD)?;
    while subscribers.iter().any(|(_, measurement)| measurement.repetitions < options.repetitions) {
        interval.tick().await?;
        publishers.send().await?;
        for (subscriber, measurement) in &mut subscribers {
            if measurement.repetitions < options.repetitions
                && let Some(line) = subscriber.try_next_line()?
            {
                measurement.record(&line)?;
            }
        }
    }
    Ok(subscribers.into_iter().map(|(_, measurement)| measurement).collect())
}

impl Measurement {
    fn new() -> scl::Result<Self> {
        Ok(Self { ages: Durations::new()?, calls: Durations::new()?, repetitions: 0 })
    }

    /// Records what a subscriber prints: the age and the time of the call, in nanoseconds.
    fn record(&mut self, line: &str) -> scl::Result<()> {
        let invalid = || scl::Error::message(format!("a subscriber printed `{line}`"));
        let (age, call) = line.split_once(' ').ok_or_else(invalid)?;
        self.ages.record(age.parse()?);
        self.calls.record(call.parse()?);
        self.repetitions += 1;
        Ok(())
    }
}

fn table(options: &FreshOptions, measurements: &[Measurement]) -> Table {
    let FreshOptions { repetitions, pause } = options;
    let title =
        format!("first value after a pause of {pause:?} with `queue: 1` at 1000 Hz ({repetitions} repetitions)");
    let mut table = Table::new(title, &COLUMNS);
    let periods = |microseconds: f64| microseconds / PERIOD.as_micros() as f64;
    for (variant, Measurement { ages, calls, .. }) in VARIANTS.iter().zip(measurements) {
        let values = vec![periods(ages.quantile(0.5)), periods(ages.max()), calls.quantile(0.5), calls.max()];
        table.add(Row::new(variant.name, values).with_baselines(variant.baselines).with_durations(ages));
    }
    table
}
