//! The time a message takes to another process and back.

mod client;
mod components;
mod echo;
#[cfg(feature = "libzmq")]
mod libzmq;

pub(crate) use echo::run_echo;

use crate::durations::Durations;
use crate::message_size::check_message_sizes;
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::worker::Worker;
use client::Client;
use scl::bytes::Bytes;
use std::ops::RangeInclusive;
use tokio::runtime::Runtime;

/// Messages of one variant before the next variant has its turn.
const BATCH: usize = 500;

/// Bytes that each variant sends at most in each direction, so that long messages do not take minutes.
const MAX_BYTES: usize = 4 << 30;

/// Options of [`measure_roundtrip`].
#[derive(Debug, Clone)]
pub struct RoundtripOptions {
    /// The message sizes in bytes, one table each; within [`RoundtripOptions::BYTES`].
    pub bytes: Vec<usize>,
    /// The number of round trips for each variant and size; at most 4 GiB are sent.
    pub messages: usize,
}

impl RoundtripOptions {
    /// The supported message sizes. Some ten processes keep a few messages each in memory.
    pub const BYTES: RangeInclusive<usize> = 1..=16 << 20;
}

/// A way to exchange messages: its name between the processes, in the report, and what it is compared with.
struct Variant {
    id: &'static str,
    name: &'static str,
    baselines: &'static [&'static str],
}

const SCL_PUB: &str = "SCL pub/sub";
const SCL_PUB_BLOCKING: &str = "SCL pub/sub (blocking)";
const SCL_REQ: &str = "SCL req/rep";
const SCL_REQ_BLOCKING: &str = "SCL req/rep (blocking)";
const ZEROMQ_PUB: &str = "zeromq XPUB/SUB";
const ZEROMQ_REQ: &str = "zeromq DEALER/ROUTER";
const LIBZMQ_PUB: &str = "libzmq XPUB/SUB";
const LIBZMQ_REQ: &str = "libzmq REQ/REP";
const UNIX: &str = "Unix socket (tokio)";
const UNIX_BLOCKING: &str = "Unix socket (blocking)";

const VARIANTS: &[Variant] = &[
    Variant { id: "scl-pub", name: SCL_PUB, baselines: &[UNIX, ZEROMQ_PUB, LIBZMQ_PUB] },
    Variant { id: "scl-req", name: SCL_REQ, baselines: &[UNIX, ZEROMQ_REQ, LIBZMQ_REQ] },
    Variant { id: "zeromq-pub", name: ZEROMQ_PUB, baselines: &[] },
    Variant { id: "zeromq-req", name: ZEROMQ_REQ, baselines: &[] },
    Variant { id: "unix", name: UNIX, baselines: &[] },
    Variant { id: "scl-pub-blocking", name: SCL_PUB_BLOCKING, baselines: &[UNIX_BLOCKING, LIBZMQ_PUB, SCL_PUB] },
    Variant { id: "scl-req-blocking", name: SCL_REQ_BLOCKING, baselines: &[UNIX_BLOCKING, LIBZMQ_REQ, SCL_REQ] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-pub-blocking", name: LIBZMQ_PUB, baselines: &[] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-req-blocking", name: LIBZMQ_REQ, baselines: &[] },
    Variant { id: "unix-blocking", name: UNIX_BLOCKING, baselines: &[] },
];

/// A variant with its two processes, and what was measured of it.
struct Measurement {
    variant: &'static Variant,
    client: Client,
    _echo: Worker,
    durations: Durations,
    /// The median of each batch, in microseconds.
    medians: Vec<f64>,
}

/// Measures the round-trip time of all variants.
///
/// # Errors
///
/// A size is outside [`RoundtripOptions::BYTES`], the folder for temporary files cannot be used, a process cannot be
/// started, or a connection fails.
pub fn measure_roundtrip(options: &RoundtripOptions) -> scl::Result<Report> {
    check_message_sizes(&options.bytes, RoundtripOptions::BYTES)?;
    let mut report = Report::new("roundtrip");
    let runtime = start_runtime()?;
    for &bytes in &options.bytes {
        report.add(measure_size(&runtime, bytes, options.messages)?);
    }
    report.note_rounds();
    Ok(report)
}

fn measure_size(runtime: &Runtime, bytes: usize, messages: usize) -> scl::Result<Table> {
    let folder = ScratchFolder::new()?;
    let mut measurements = Vec::new();
    for variant in VARIANTS {
        let (client, echo) = Client::start(runtime, variant.id, folder.path(), bytes)?;
        let (durations, medians) = (Durations::new()?, Vec::new());
        measurements.push(Measurement { variant, client, _echo: echo, durations, medians });
    }
    let payload = Bytes::from(vec![7; bytes]);
    let mut batch = Vec::with_capacity(BATCH);
    for messages in batches(messages.min(MAX_BYTES / bytes)) {
        for measurement in &mut measurements {
            measurement.run(runtime, &payload, messages, &mut batch)?;
        }
    }
    Ok(table(bytes, &measurements))
}

fn batches(messages: usize) -> impl Iterator<Item = usize> {
    (0..messages).step_by(BATCH).map(move |done| BATCH.min(messages - done))
}

impl Measurement {
    /// Measures one batch after a tenth of it as warm-up, because the other variants have cooled the caches.
    fn run(&mut self, runtime: &Runtime, payload: &Bytes, messages: usize, batch: &mut Vec<u64>) -> scl::Result<()> {
        self.client.exchange(runtime, payload, messages.div_ceil(10), batch)?;
        self.client.exchange(runtime, payload, messages, batch)?;
        batch.iter().for_each(|duration| self.durations.record(*duration));
        batch.sort_unstable();
        self.medians.push(batch[batch.len() / 2] as f64 / 1e3);
        Ok(())
    }
}

fn table(bytes: usize, measurements: &[Measurement]) -> Table {
    let columns = [Column::compared("p50_us"), Column::compared("p99_us")];
    let mut table = Table::new(format!("round trip of {bytes} bytes between two processes"), &columns);
    for Measurement { variant, durations, medians, .. } in measurements {
        let values = vec![durations.quantile(0.5), durations.quantile(0.99)];
        let row = Row::new(variant.name, values).with_rounds(medians).with_durations(durations);
        table.add(row.with_baselines(variant.baselines));
    }
    table
}
