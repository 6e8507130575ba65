//! The number of messages per second from one process to another, without losing any.

use crate::message_size::check_message_sizes;
use crate::one_way::{
    Channel, LIBZMQ_NODROP, LIBZMQ_PUB, LIBZMQ_PUSH, LIBZMQ_PUSH_UNLIMITED, MIN_SIZE, SCL_PUB, SCL_PUB_BLOCKING,
    SCL_PUSH, SCL_PUSH_BLOCKING, Timing, UNIX, Variant, ZEROMQ_PUB, ZEROMQ_PUSH,
};
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use std::ops::RangeInclusive;
use tokio::runtime::Runtime;

/// The minimum number of batches of each variant, after one for warm-up.
const MIN_BATCHES: usize = 10;

/// The largest batch in bytes: libzmq without a limit may keep a whole batch in memory.
const MAX_BATCH_BYTES: usize = 32 << 20;

/// Bytes that each variant sends at most, so that long messages do not take minutes.
const MAX_BYTES: usize = 4 << 30;

const PUB_BASELINES: &[Variant] = &[LIBZMQ_NODROP, LIBZMQ_PUB, ZEROMQ_PUB];
const PUSH_BASELINES: &[Variant] = &[LIBZMQ_PUSH, LIBZMQ_PUSH_UNLIMITED, ZEROMQ_PUSH];

/// All variants, with the variants they are compared with.
const VARIANTS: &[(Variant, &[Variant])] = &[
    (SCL_PUB, PUB_BASELINES),
    (SCL_PUB_BLOCKING, PUB_BASELINES),
    (ZEROMQ_PUB, &[]),
    #[cfg(feature = "libzmq")]
    (LIBZMQ_NODROP, &[]),
    #[cfg(feature = "libzmq")]
    (LIBZMQ_PUB, &[]),
    (SCL_PUSH, PUSH_BASELINES),
    (SCL_PUSH_BLOCKING, PUSH_BASELINES),
    (ZEROMQ_PUSH, &[]),
    #[cfg(feature = "libzmq")]
    (LIBZMQ_PUSH, &[]),
    #[cfg(feature = "libzmq")]
    (LIBZMQ_PUSH_UNLIMITED, &[]),
    (UNIX, &[]),
];

/// Options of [`measure_rate`].
#[derive(Debug, Clone)]
pub struct RateOptions {
    /// The message sizes in bytes, one table each; within [`RateOptions::BYTES`].
    pub bytes: Vec<usize>,
    /// The number of messages for each variant and size; at most 4 GiB are sent.
    pub messages: usize,
}

impl RateOptions {
    /// The supported message sizes: 8 bytes are for the time, and up to 1000 messages wait in memory.
    pub const BYTES: RangeInclusive<usize> = MIN_SIZE..=1 << 20;
}

/// How the messages of a run are divided.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Batches {
    size: usize,
    count: usize,
}

/// A variant with its two processes, and what was measured of it.
struct Measurement {
    variant: Variant,
    baselines: &'static [Variant],
    channel: Channel,
    /// The messages per second of each batch.
    rates: Vec<f64>,
}

/// Measures the rate of messages of all variants.
///
/// # Errors
///
/// A size is outside [`RateOptions::BYTES`], the folder for temporary files cannot be used, a process cannot be
/// started, or a connection fails.
pub fn measure_rate(options: &RateOptions) -> scl::Result<Report> {
    check_message_sizes(&options.bytes, RateOptions::BYTES)?;
    let mut report = Report::new("rate");
    let runtime = start_runtime()?;
    for &bytes in &options.bytes {
        report.add(measure_size(&runtime, bytes, options.messages)?);
    }
    report.note_rounds();
    Ok(report)
}

fn measure_size(runtime: &Runtime, bytes: usize, messages: usize) -> scl::Result<Table> {
    let folder = ScratchFolder::new()?;
    let batches = Batches::new(messages, bytes);
    let mut measurements = Vec::new();
    for &(variant, baselines) in VARIANTS {
        let channel = Channel::open(runtime, variant, folder.path(), bytes, batches.size, Timing::Batch)?;
        measurements.push(Measurement { variant, baselines, channel, rates: Vec::new() });
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
        // A rate takes at least two messages.
        let size = (messages / MIN_BATCHES).min(MAX_BATCH_BYTES / bytes).max(2);
        Self { size, count: (messages / size).max(MIN_BATCHES) }
    }
}

impl Measurement {
    fn run(&mut self, runtime: &Runtime, batch: usize, is_recorded: bool) -> scl::Result<()> {
        self.channel.send_batch(runtime)?;
        let report = runtime.block_on(self.channel.batch_report())?;
        if is_recorded {
            // At least a nanosecond, so that there is a rate even if the clock did not advance.
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
        let baselines: Vec<&str> = measurement.baselines.iter().map(|baseline| baseline.name).collect();
        let row = Row::new(measurement.variant.name, vec![measurement.median_rate()]).with_baselines(&baselines);
        table.add(row.with_rounds(&measurement.rates));
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

    #[test]
    fn sizes_outside_the_range_are_rejected() {
        for rejected in [7, (1 << 20) + 1] {
            let error = measure_rate(&RateOptions { bytes: vec![20, rejected], messages: 2 }).unwrap_err();
            assert_eq!(error.to_string(), format!("a message has 8 to 1048576 bytes, not {rejected}"));
        }
    }
}
