//! The number of messages per second from one process to another, without losing any.

use crate::message::MIN_SIZE;
use crate::one_way::{Channel, SCL_PUB, Timing, ZEROMQ_PUB};
use crate::report::{Column, Report, Row, Table};
use crate::runtime::{run, start_runtime};
use crate::scratch::ScratchFolder;
use crate::transport::Transport;
use crate::variant::{UNIX, Variant, over};
use std::ops::RangeInclusive;
use tokio::runtime::Runtime;

const LIBZMQ_NODROP: &str = "libzmq XPUB_NODROP";
const LIBZMQ_PUB: &str = "libzmq XPUB (no limit)";
const LIBZMQ_PUSH: &str = "libzmq PUSH";
const LIBZMQ_PUSH_UNLIMITED: &str = "libzmq PUSH (no limit)";
const ZEROMQ_PUSH: &str = "zeromq PUSH/PULL";

const PUB_BASELINES: &[&str] = &[LIBZMQ_NODROP, LIBZMQ_PUB, ZEROMQ_PUB.name];
const PUSH_BASELINES: &[&str] = &[LIBZMQ_PUSH, LIBZMQ_PUSH_UNLIMITED, ZEROMQ_PUSH];

/// The variants over Unix sockets, in the order of their turns.
const IPC: &[Variant] = &[
    Variant { baselines: PUB_BASELINES, ..SCL_PUB },
    Variant { id: "scl-pub-blocking", name: "SCL pub/sub (blocking)", baselines: PUB_BASELINES },
    ZEROMQ_PUB,
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-nodrop", name: LIBZMQ_NODROP, baselines: &[] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-pub", name: LIBZMQ_PUB, baselines: &[] },
    Variant { id: "scl-push", name: "SCL push/pull", baselines: PUSH_BASELINES },
    Variant { id: "scl-push-blocking", name: "SCL push/pull (blocking)", baselines: PUSH_BASELINES },
    Variant { id: "zeromq-push", name: ZEROMQ_PUSH, baselines: &[] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-push", name: LIBZMQ_PUSH, baselines: &[] },
    #[cfg(feature = "libzmq")]
    Variant { id: "libzmq-push-unlimited", name: LIBZMQ_PUSH_UNLIMITED, baselines: &[] },
    UNIX,
];

/// The minimum number of batches of each variant, after one for warm-up.
const MIN_BATCHES: usize = 10;

/// The largest batch in bytes: libzmq without a limit may keep a whole batch in memory.
const MAX_BATCH_BYTES: usize = 32 << 20;

/// Maximum number of bytes that each variant sends, so that long messages do not take minutes.
const MAX_BYTES: usize = 4 << 30;

/// The supported message sizes in bytes; the first 8 bytes hold the time.
pub(crate) const BYTES: RangeInclusive<usize> = MIN_SIZE..=4 << 20;

/// How the messages of a run are divided into batches.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Batches {
    size: usize,
    count: usize,
}

/// A variant with its two processes, and its measurements.
struct Measurement {
    variant: Variant,
    channel: Channel,
    /// The messages per second of each batch.
    rates: Vec<f64>,
}

/// Measures the rate of messages of all variants, with a table for each size in bytes.
pub(crate) fn measure_rate(sizes: &[usize], messages: usize, transport: Transport) -> scl::Result<Report> {
    transport.check_is_built_in()?;
    let mut report = Report::new("rate");
    let runtime = start_runtime()?;
    for &bytes in sizes {
        report.tables.push(measure_size(&runtime, messages, transport, bytes)?);
    }
    report.note_rounds();
    Ok(report)
}

fn measure_size(runtime: &Runtime, messages: usize, transport: Transport, bytes: usize) -> scl::Result<Table> {
    let folder = ScratchFolder::new()?;
    let batches = Batches::new(messages, bytes);
    let mut measurements = Vec::new();
    for &variant in over(transport, IPC) {
        let open = Channel::open(variant, &folder.path, bytes, batches.size, Timing::Batch);
        let channel = run(runtime, variant.id, open)?;
        measurements.push(Measurement { variant, channel, rates: Vec::new() });
    }
    // The first batch is warm-up.
    for batch in 0..=batches.count {
        for measurement in &mut measurements {
            measurement.run(runtime, batches.size, batch > 0)?;
        }
    }
    Ok(table(bytes, &measurements))
}

impl Batches {
    fn new(messages: usize, bytes: usize) -> Self {
        let messages = messages.min(MAX_BYTES / bytes);
        // Measuring a rate takes at least two messages.
        let size = (messages / MIN_BATCHES).min(MAX_BATCH_BYTES / bytes).max(2);
        Self { size, count: (messages / size).max(MIN_BATCHES) }
    }
}

impl Measurement {
    fn run(&mut self, runtime: &Runtime, batch: usize, is_recorded: bool) -> scl::Result<()> {
        self.channel.send_batch(runtime)?;
        let report = runtime.block_on(self.channel.batch_report())?;
        if is_recorded {
            // Count at least one nanosecond: the rate would be infinite if the clock did not advance.
            self.rates.push(batch as f64 * 1e9 / report.span.max(1) as f64);
        }
        Ok(())
    }

    fn median_rate(&self) -> f64 {
        let mut rates = self.rates.clone();
        rates.sort_unstable_by(f64::total_cmp);
        rates[rates.len() / 2]
    }
}

fn table(bytes: usize, measurements: &[Measurement]) -> Table {
    let columns = [Column::compared("messages_per_s")];
    let title = format!("rate of {bytes} bytes from one process to another, none lost (median of all batches)");
    let mut table = Table::new(title, &columns);
    for measurement in measurements {
        let row = Row::new(measurement.variant.name, vec![measurement.median_rate()])
            .with_baselines(measurement.variant.baselines);
        table.rows.push(row.with_rounds(&measurement.rates));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_of_long_messages_are_small() {
        for (messages, bytes, size, count) in
            [(500_000, 20, 50_000, 10), (50, 20, 5, 10), (1, 8, 2, 10), (500_000, 1 << 20, 32, 128)]
        {
            assert_eq!(Batches::new(messages, bytes), Batches { size, count }, "{messages} of {bytes} bytes");
        }
    }
}
