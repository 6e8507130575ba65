//! The time a message takes to another process and back.

mod client;
mod echo;

pub(crate) use echo::run_echo;

use crate::durations::Durations;
use crate::message::Message;
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::transport::Transport;
use crate::variant::{UNIX, UNIX_BLOCKING, UNIX_BLOCKING_NAME, UNIX_NAME, Variant, over};
use client::Client;
use std::ops::RangeInclusive;
use tokio::runtime::Runtime;

/// Number of messages sent through one variant before the next variant has its turn.
const BATCH: usize = 500;

/// Maximum number of bytes that each variant sends in each direction, so that long messages do not take minutes.
const MAX_BYTES: usize = 4 << 30;

const SCL_PUB: &str = "SCL pub/sub";
const SCL_PUB_BLOCKING: &str = "SCL pub/sub (blocking)";
const SCL_REQ: &str = "SCL req/rep";
const SCL_REQ_BLOCKING: &str = "SCL req/rep (blocking)";
const ZEROMQ_PUB: &str = "zeromq XPUB/SUB";
const ZEROMQ_REQ: &str = "zeromq DEALER/ROUTER";
const LIBZMQ_PUB: &str = "libzmq XPUB/SUB";
const LIBZMQ_REQ: &str = "libzmq REQ/REP";

/// The variants over Unix sockets, in the order of their turns.
const IPC: &[Variant] = &[
    Variant { id: "scl-pub", name: SCL_PUB, baselines: &[UNIX_NAME, ZEROMQ_PUB, LIBZMQ_PUB] },
    Variant { id: "scl-req", name: SCL_REQ, baselines: &[UNIX_NAME, ZEROMQ_REQ, LIBZMQ_REQ] },
    Variant { id: "zeromq-pub", name: ZEROMQ_PUB, baselines: &[] },
    Variant { id: "zeromq-req", name: ZEROMQ_REQ, baselines: &[] },
    UNIX,
    Variant { id: "scl-pub-blocking", name: SCL_PUB_BLOCKING, baselines: &[UNIX_BLOCKING_NAME, LIBZMQ_PUB, SCL_PUB] },
    Variant { id: "scl-req-blocking", name: SCL_REQ_BLOCKING, baselines: &[UNIX_BLOCKING_NAME, LIBZMQ_REQ, SCL_REQ] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-pub-blocking", name: LIBZMQ_PUB, baselines: &[] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-req-blocking", name: LIBZMQ_REQ, baselines: &[] },
    UNIX_BLOCKING,
];

/// The supported message sizes in bytes, limited because some ten processes keep a few messages each in memory.
pub(crate) const BYTES: RangeInclusive<usize> = 1..=16 << 20;

/// The longest message over transports other than Unix sockets: shared memory is reserved for all messages that may be
/// in flight.
const MAX_BYTES_ELSEWHERE: usize = 4 << 20;

/// A variant with its two processes, and its measurements.
struct Measurement {
    variant: &'static Variant,
    client: Client<'static>,
    durations: Durations,
    /// The median of each batch, in microseconds.
    medians: Vec<f64>,
}

/// Measures the round-trip time of all variants, with a table for each size in bytes.
pub(crate) fn measure_roundtrip(sizes: &[usize], messages: usize, transport: Transport) -> scl::Result<Report> {
    transport.check_is_built_in()?;
    let max = if transport == Transport::Ipc { *BYTES.end() } else { MAX_BYTES_ELSEWHERE };
    if let Some(rejected) = sizes.iter().find(|size| **size > max) {
        return Err(scl::Error::message(format!("a message has 1 to {max} bytes, not {rejected}")));
    }
    let mut report = Report::new("roundtrip");
    let runtime = start_runtime()?;
    for &bytes in sizes {
        report.tables.push(measure_size(&runtime, messages, transport, bytes)?);
    }
    report.note_rounds();
    Ok(report)
}

fn measure_size(runtime: &Runtime, messages: usize, transport: Transport, bytes: usize) -> scl::Result<Table> {
    let folder = ScratchFolder::new()?;
    let mut measurements = Vec::new();
    for variant in over(transport, IPC) {
        let client = Client::start(runtime, variant.id, &folder.path, bytes)?;
        let (durations, medians) = (Durations::new()?, Vec::new());
        measurements.push(Measurement { variant, client, durations, medians });
    }
    let message = Message::new(bytes);
    let mut batch = Vec::with_capacity(BATCH);
    for messages in batches(messages.min(MAX_BYTES / bytes)) {
        for measurement in &mut measurements {
            measurement.run(runtime, &message, messages, &mut batch)?;
        }
    }
    Ok(table(bytes, &measurements))
}

fn batches(messages: usize) -> impl Iterator<Item = usize> {
    (0..messages).step_by(BATCH).map(move |done| BATCH.min(messages - done))
}

impl Measurement {
    /// Measures one batch after a tenth of it as warm-up, because the other variants have cooled the caches.
    fn run(&mut self, runtime: &Runtime, message: &Message, messages: usize, batch: &mut Vec<u64>) -> scl::Result<()> {
        self.client.exchange(runtime, message, messages.div_ceil(10), batch)?;
        self.client.exchange(runtime, message, messages, batch)?;
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
        table.rows.push(row.with_baselines(variant.baselines));
    }
    table
}
