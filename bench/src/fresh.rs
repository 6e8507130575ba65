//! The age of the first value that a subscriber receives after a pause.
//!
//! A control loop that was busy must not act on old values: with `queue: 1`, the first value should be the newest.

mod subscriber;

pub(crate) use subscriber::run_subscriber;

use crate::components::fresh::Publisher;
use crate::durations::Durations;
use crate::ends::{Calls, Sender};
use crate::link::{CONNECT_TIMEOUT, connect, open};
use crate::message::Message;
use crate::raw::SocketPaths;
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::variant::Variant;
use crate::worker::Worker;
use scl::time::interval;
use std::time::Duration;
use zeromq::PubSocket;

const PERIOD: Duration = Duration::from_millis(1);

/// The size of a message: the time at which it was sent, padded to the size that the other benchmarks use.
const BYTES: usize = 20;

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

/// The publisher and the subscriber of a variant, and the measurements.
struct Measurement {
    publisher: Sender,
    subscriber: Worker,
    /// From sending the first value after a pause to receiving it.
    ages: Durations,
    /// Duration of the call that received it.
    calls: Durations,
    repetitions: usize,
}

/// Measures the age of the first value after a pause, at 1000 values per second.
///
/// All subscribers run at the same time, so that a repetition takes one pause.
pub(crate) fn measure_fresh(repetitions: usize, pause: Duration) -> scl::Result<Report> {
    let folder = ScratchFolder::new()?;
    let measurements = start_runtime()?.block_on(run(&folder.path, repetitions, pause))?;
    let mut report = Report::new("fresh");
    report.tables.push(table(repetitions, pause, &measurements));
    report.note("one period is 1 ms; the newest value is at most about one period old");
    report.note("the pause blocks the thread, except in the line `polled`, where the runtime runs");
    Ok(report)
}

async fn run(folder: &str, repetitions: usize, pause: Duration) -> scl::Result<Vec<Measurement>> {
    let arguments = [repetitions as u128, pause.as_micros()].map(|number| number.to_string());
    let mut measurements = Vec::new();
    for (index, variant) in VARIANTS.iter().enumerate() {
        let subscriber = ["fresh", variant.id, folder, &arguments[0], &arguments[1], &index.to_string()];
        measurements.push(Measurement::start(variant, folder, &subscriber).await?);
    }
    let mut interval = interval(PERIOD)?;
    while measurements.iter().any(|measurement| measurement.repetitions < repetitions) {
        interval.tick().await?;
        for measurement in &mut measurements {
            let Message { payload, .. } = Message::sent_now(BYTES);
            measurement.publisher.send(&payload.into()).await?;
        }
        for measurement in &mut measurements {
            if measurement.repetitions < repetitions
                && let Some(line) = measurement.subscriber.try_next_line()?
            {
                measurement.record(&line)?;
            }
        }
    }
    Ok(measurements)
}

impl Measurement {
    /// Opens the publisher and starts the subscriber. A publisher of SCL waits for its subscriber; the others drop
    /// values until a subscriber has connected.
    async fn start(variant: &Variant, folder: &str, subscriber: &[&str]) -> scl::Result<Self> {
        let paths = SocketPaths::new(folder, variant.id);
        let raw = match variant.id {
            "zeromq" => Some(Sender::Zeromq(Box::new(paths.bind::<PubSocket>("position").await?))),
            #[cfg(feature = "libzmq")]
            "libzmq" => {
                let mark = crate::libzmq::HighWaterMark::Default;
                Some(Sender::Libzmq(paths.bind_libzmq("position", zmq2::PUB, mark)?))
            }
            _ => None,
        };
        let subscriber = Worker::start(subscriber)?;
        let publisher = match raw {
            Some(publisher) => publisher,
            None => {
                let options = scl::OpenOptions::new().runtime_dir(folder).system(variant.id);
                Sender::Pub(connect!(Publisher, options, false).position, Calls::default())
            }
        };
        let (ages, calls) = (Durations::new()?, Durations::new()?);
        Ok(Self { publisher, subscriber, ages, calls, repetitions: 0 })
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

fn table(repetitions: usize, pause: Duration, measurements: &[Measurement]) -> Table {
    let title =
        format!("first value after a pause of {pause:?} with `queue: 1` at 1000 Hz ({repetitions} repetitions)");
    let mut table = Table::new(title, &COLUMNS);
    let periods = |microseconds: f64| microseconds / PERIOD.as_micros() as f64;
    for (variant, Measurement { ages, calls, .. }) in VARIANTS.iter().zip(measurements) {
        let values = vec![periods(ages.quantile(0.5)), periods(ages.max()), calls.quantile(0.5), calls.max()];
        table.rows.push(Row::new(variant.name, values).with_baselines(variant.baselines).with_durations(ages));
    }
    table
}
