//! The cost of a component with ten gates before it exchanges messages: time to open, memory, wake-ups.

mod components;
mod station;

pub(crate) use station::run_station;

use crate::durations::Durations;
use crate::footprint;
use crate::report::{Column, Report, Row, Table};
use crate::runtime::start_runtime;
use crate::scratch::ScratchFolder;
use crate::worker::Worker;
use std::thread::sleep;
use std::time::{Duration, Instant};
use tokio::runtime::Runtime;

/// Options of [`measure_open`].
#[derive(Debug, Clone)]
pub struct OpenOptions {
    /// How often each kind of process is started.
    pub starts: usize,
    /// How long each kind of process is observed while idle, after the same time to settle.
    pub idle: Duration,
}

/// What a process opens.
struct Variant {
    id: &'static str,
    name: &'static str,
    baselines: &'static [&'static str],
    with_neighbour: bool,
}

const ZEROMQ: &str = "10 zeromq sockets";

const VARIANTS: [Variant; 4] = [
    Variant { id: "station", name: "SCL, 10 gates, alone", baselines: &[ZEROMQ], with_neighbour: false },
    Variant { id: "station", name: "SCL, 10 gates, connected", baselines: &[ZEROMQ], with_neighbour: true },
    Variant { id: "sockets", name: ZEROMQ, baselines: &[], with_neighbour: false },
    Variant { id: "nothing", name: "async runtime only", baselines: &[], with_neighbour: false },
];

const COLUMNS: [Column; 4] = [
    Column::compared("open_p50_us"),
    Column::plain("open_max_us"),
    Column::compared("memory_kib"),
    Column::plain("wakeups_per_s"),
];

/// What was measured of a variant.
struct Measurement {
    opening: Durations,
    memory: f64,
    wakeups: f64,
}

/// Starts processes that open a component with ten gates, and processes that open raw sockets, and observes them.
///
/// # Errors
///
/// The folder for temporary files cannot be used, a process cannot be started, or `/proc` cannot be read.
pub fn measure_open(options: &OpenOptions) -> scl::Result<Report> {
    let runtime = start_runtime()?;
    let mut measurements = Vec::new();
    for _ in &VARIANTS {
        measurements.push(Measurement { opening: Durations::new()?, memory: 0.0, wakeups: 0.0 });
    }
    let starts = options.starts.max(1);
    for start in 1..=starts {
        for (variant, measurement) in VARIANTS.iter().zip(&mut measurements) {
            let idle = (start == starts).then_some(options.idle);
            measurement.run(&runtime, variant, idle)?;
        }
    }
    let mut report = Report::new("open");
    report.add(table(&measurements));
    report.note("memory is the resident memory, including the program's code");
    report.note("of the `zeromq` sockets, the five that listen are bound and none is connected");
    Ok(report)
}

impl Measurement {
    /// Starts a process once, and observes it for a while if `idle` is given.
    fn run(&mut self, runtime: &Runtime, variant: &Variant, idle: Option<Duration>) -> scl::Result<()> {
        let folder = ScratchFolder::new()?;
        let ready = if variant.with_neighbour { "connected" } else { "alone" };
        let mut process = Worker::start(&["open", variant.id, folder.path(), ready])?;
        self.opening.record(runtime.block_on(process.next_line())?.parse()?);
        let start_neighbour = || Worker::start(&["open", "neighbour", folder.path(), ready]);
        let _neighbour = variant.with_neighbour.then(start_neighbour).transpose()?;
        let _idle = runtime.block_on(process.next_line())?;
        if let Some(idle) = idle {
            sleep(idle);
            let (before, started) = (footprint::context_switches(process.id())?, Instant::now());
            sleep(idle);
            let switches = footprint::context_switches(process.id())? - before;
            self.wakeups = switches as f64 / started.elapsed().as_secs_f64();
            self.memory = footprint::resident_kib(process.id())? as f64;
        }
        Ok(())
    }
}

fn table(measurements: &[Measurement]) -> Table {
    let mut table = Table::new("a process with a component of ten gates", &COLUMNS);
    for (variant, Measurement { opening, memory, wakeups }) in VARIANTS.iter().zip(measurements) {
        let values = vec![opening.quantile(0.5), opening.max(), *memory, *wakeups];
        table.add(Row::new(variant.name, values).with_baselines(variant.baselines).with_durations(opening));
    }
    table
}
