//! How many messages a second go from one process to another, with nothing lost.

use crate::AllocationCount;
use crate::histogram::Times;
use crate::lengths::check_lengths;
use crate::one_way::{self, Lane, SHORTEST, Way};
use crate::processes::{as_text, scratch_folder, start_runtime};
use crate::report::{Column, Report, Row, Table};
use std::ops::RangeInclusive;
use tokio::runtime::Runtime;

/// Batches of each way at least, after one that only warms up.
const BATCHES: usize = 10;

/// The greatest batch in bytes: libzmq without a high-water mark may hold all of it in memory.
const BATCH_BYTES: usize = 32 << 20;

const WAYS: &[&Way] = &[
    &one_way::SCL_PUBLISH,
    &one_way::RAW_PUBLISH,
    #[cfg(feature = "libzmq")]
    &one_way::LIBZMQ_PUBLISH,
    &one_way::SCL_PUSH,
    &one_way::RAW_PUSH,
    #[cfg(feature = "libzmq")]
    &one_way::LIBZMQ_PUSH,
    &one_way::UNIX,
];

/// How many messages are sent together, and how often.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Batches {
    size: usize,
    number: usize,
}

/// What [`measure_rate`] is asked for.
#[derive(Debug, Clone)]
pub struct Rate {
    /// The lengths of the messages, in bytes, one table each; within [`Rate::BYTES`].
    pub bytes: Vec<usize>,
    /// How many messages of each length go each way.
    pub messages: usize,
    /// Adds how many allocations of this process a sent message takes.
    pub allocations: Option<AllocationCount>,
}

impl Rate {
    /// The lengths that messages may have: each carries its time, 8 bytes, and 1000 of them may wait in memory.
    pub const BYTES: RangeInclusive<usize> = SHORTEST..=1 << 20;
}

/// A way in use and what came of it.
struct Measured {
    way: &'static Way,
    lane: Lane,
    /// Of each batch: nanoseconds a message.
    paces: Times,
    delays: Times,
    allocations: u64,
}

/// Measures the rate of messages for every way, beside each other.
///
/// # Errors
///
/// A length outside [`Rate::BYTES`]; the folder for temporary files cannot be used, a process cannot be started, or a
/// connection fails.
pub fn measure_rate(options: &Rate) -> scl::Result<Report> {
    check_lengths(&options.bytes, Rate::BYTES)?;
    let mut report = Report::new("rate");
    let runtime = start_runtime()?;
    for &bytes in &options.bytes {
        report.add(measure_length(&runtime, bytes, options)?);
    }
    Ok(report)
}

fn measure_length(runtime: &Runtime, bytes: usize, options: &Rate) -> scl::Result<Table> {
    let folder = scratch_folder()?;
    let batches = Batches::of(options.messages, bytes);
    let mut all = Vec::new();
    for way in WAYS {
        let lane = Lane::open(runtime, way, as_text(folder.path())?, bytes, batches.size)?;
        all.push(Measured { way, lane, paces: Times::new()?, delays: Times::new()?, allocations: 0 });
    }
    for round in 0..=batches.number {
        for measured in &mut all {
            measured.play(runtime, batches.size, round > 0, options.allocations)?;
        }
    }
    Ok(table(bytes, batches, &all, options.allocations.is_some()))
}

impl Batches {
    fn of(messages: usize, bytes: usize) -> Self {
        // A rate takes two messages at least.
        let size = (messages / BATCHES).min(BATCH_BYTES / bytes).max(2);
        Self { size, number: (messages / size).max(BATCHES) }
    }
}

impl Measured {
    fn play(
        &mut self,
        runtime: &Runtime,
        batch: usize,
        counts: bool,
        allocations: Option<AllocationCount>,
    ) -> scl::Result<()> {
        let allocated = || allocations.map_or(0, |count| count());
        let before = allocated();
        runtime.block_on(self.lane.send_batch())?;
        let after = allocated();
        let received = runtime.block_on(self.lane.received())?;
        if counts {
            // At least a nanosecond, so that there is a rate even of batches too small for the clock.
            self.paces.record((received.span / batch as u64).max(1));
            self.allocations += after - before;
            received.delays.iter().for_each(|delay| self.delays.record(*delay));
        }
        Ok(())
    }
}

fn table(bytes: usize, batches: Batches, all: &[Measured], counted: bool) -> Table {
    let mut columns = vec![Column::compared("messages_per_s"), Column::plain("delay_p50_us")];
    if counted {
        columns.push(Column::plain("allocations"));
    }
    let title = format!(
        "{bytes} bytes from one process to another as fast as they go, none lost (median of {})",
        batches.number
    );
    let mut table = Table::new(title, &columns);
    for measured in all {
        let mut figures = vec![1e6 / measured.paces.quantile(0.5), measured.delays.quantile(0.5)];
        if counted {
            figures.push(measured.allocations as f64 / (batches.size * batches.number) as f64);
        }
        let row = Row::new(measured.way.name, figures).beside_all(measured.way.beside);
        table.add(row.with_times(&measured.delays));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_of_long_messages_are_small() {
        for (messages, bytes, size, number) in
            [(500_000, 20, 50_000, 10), (50, 20, 5, 10), (1, 8, 2, 10), (500_000, 1 << 20, 32, 15_625)]
        {
            assert_eq!(Batches::of(messages, bytes), Batches { size, number }, "{messages} of {bytes} bytes");
        }
    }

    #[test]
    fn lengths_outside_the_range_are_refused() {
        for refused in [7, (1 << 20) + 1] {
            let error = measure_rate(&Rate { bytes: vec![20, refused], messages: 2, allocations: None }).unwrap_err();
            assert_eq!(error.to_string(), format!("a message has from 8 to 1048576 bytes, not {refused}"));
        }
    }
}
