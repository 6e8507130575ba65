//! The number of messages per second from one process to another, without losing any.

mod variants;

use crate::message_size::check_message_sizes;
use crate::one_way::{Channel, MIN_SIZE, Timing, Variant};
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::transport::Transport;
use std::ops::RangeInclusive;
use tokio::runtime::Runtime;
use variants::variants;

/// The minimum number of batches of each variant, after one for warm-up.
const MIN_BATCHES: usize = 10;

/// The largest batch in bytes: libzmq without a limit may keep a whole batch in memory.
const MAX_BATCH_BYTES: usize = 32 << 20;

/// Bytes that each variant sends at most, so that long messages do not take minutes.
const MAX_BYTES: usize = 4 << 30;

/// Options of [`measure_rate`].
#[derive(Debug, Clone)]
pub struct RateOptions {
    /// The message sizes in bytes, one table each; within [`RateOptions::BYTES`].
    pub bytes: Vec<usize>,
    /// The number of messages for each variant and size; at most 4 GiB are sent.
    pub messages: usize,
    /// What is under the connections.
    pub transport: Transport,
}

impl RateOptions {
    /// The supported message sizes: 8 bytes are for the time.
    pub const BYTES: RangeInclusive<usize> = MIN_SIZE..=4 << 20;
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
/// A size is outside [`RateOptions::BYTES`], this program was built without the transport, the folder for temporary files cannot be used, a process cannot be
/// started, or a connection fails.
pub fn measure_rate(options: &RateOptions) -> scl::Result<Report> {
    options.transport.check_is_built_in()?;
    check_message_sizes(&options.bytes, RateOptions::BYTES)?;
    let mut report = Report::new("rate");
    let runtime = start_runtime()?;
    for &bytes in &options.bytes {
        report.add(measure_size(&runtime, options, bytes)?);
    }
    report.note_rounds();
    Ok(report)
}

fn measure_size(runtime: &Runtime, options: &RateOptions, bytes: usize) -> scl::Result<Table> {
    let folder = ScratchFolder::new()?;
    let batches = Batches::new(options.messages, bytes);
    let mut measurements = Vec::new();
    for &(variant, baselines) in variants(options.transport) {
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
        for rejected in [7, (4 << 20) + 1] {
            let options = RateOptions { bytes: vec![20, rejected], messages: 2, transport: Transport::Ipc };
            let error = measure_rate(&options).unwrap_err();
            assert_eq!(error.to_string(), format!("a message has 8 to 4194304 bytes, not {rejected}"));
        }
    }
}
