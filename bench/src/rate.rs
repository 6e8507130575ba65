//! How many messages a second go from one process to another, with nothing lost.

use crate::AllocationCount;
use crate::histogram::Times;
use crate::one_way::{Lane, RAW_PUBLISH, RAW_PUSH, SCL_PUBLISH, SCL_PUSH, SHORTEST, UNIX, Way};
use crate::processes::{as_text, scratch_folder, start_runtime};
use crate::report::{Column, Report, Row, Table};
use tokio::runtime::Runtime;

/// Batches of each way, after one that only warms up.
const BATCHES: usize = 10;

const WAYS: [&Way; 5] = [&SCL_PUBLISH, &RAW_PUBLISH, &SCL_PUSH, &RAW_PUSH, &UNIX];

/// What [`measure_rate`] is asked for.
#[derive(Debug, Clone)]
pub struct Rate {
    /// The lengths of the messages, in bytes, one table each; at least 8.
    pub bytes: Vec<usize>,
    /// How many messages of each length go each way.
    pub messages: usize,
    /// Adds how many allocations of this process a sent message takes.
    pub allocations: Option<AllocationCount>,
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
/// A length of less than 8 bytes; the folder for temporary files cannot be used, a process cannot be started, or a
/// connection fails.
pub fn measure_rate(options: &Rate) -> scl::Result<Report> {
    if let Some(short) = options.bytes.iter().find(|bytes| **bytes < SHORTEST) {
        let text = format!("messages of {short} bytes are too short: each carries its time, {SHORTEST} bytes");
        return Err(scl::Error::message(text));
    }
    let mut report = Report::new("rate");
    let runtime = start_runtime()?;
    for &bytes in &options.bytes {
        report.add(measure_length(&runtime, bytes, options)?);
    }
    Ok(report)
}

fn measure_length(runtime: &Runtime, bytes: usize, options: &Rate) -> scl::Result<Table> {
    let folder = scratch_folder()?;
    // A rate takes two messages at least.
    let batch = (options.messages / BATCHES).max(2);
    let mut all = Vec::new();
    for way in WAYS {
        let lane = Lane::open(runtime, way, as_text(folder.path())?, bytes, batch)?;
        all.push(Measured { way, lane, paces: Times::new()?, delays: Times::new()?, allocations: 0 });
    }
    for round in 0..=BATCHES {
        for measured in &mut all {
            measured.play(runtime, batch, round > 0, options.allocations)?;
        }
    }
    Ok(table(bytes, batch, &all, options.allocations.is_some()))
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
            self.paces.record((received.span / (batch as u64 - 1)).max(1));
            self.allocations += after - before;
            received.delays.iter().for_each(|delay| self.delays.record(*delay));
        }
        Ok(())
    }
}

fn table(bytes: usize, batch: usize, all: &[Measured], counted: bool) -> Table {
    let mut columns = vec![Column::compared("messages_per_s"), Column::plain("delay_p50_us")];
    if counted {
        columns.push(Column::plain("allocations"));
    }
    let title =
        format!("{bytes} bytes from one process to another as fast as they go, none lost (median of {BATCHES})");
    let mut table = Table::new(title, &columns);
    for measured in all {
        let mut figures = vec![1e6 / measured.paces.quantile(0.5), measured.delays.quantile(0.5)];
        if counted {
            figures.push(measured.allocations as f64 / (batch * BATCHES) as f64);
        }
        let row = Row::new(measured.way.name, figures).beside_all(measured.way.beside);
        table.add(row.with_times(&measured.delays));
    }
    table
}
