//! What a component of ten gates costs before it says anything: time to open, memory, wake-ups.

mod components;
mod footprint;
mod station;

pub(crate) use station::play;

use crate::histogram::Times;
use crate::processes::{OtherProcess, as_text, scratch_folder, start_runtime};
use crate::report::{Column, Others, Report, Row, Table};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tokio::runtime::Runtime;

/// What [`measure_open`] is asked for.
#[derive(Debug, Clone)]
pub struct Open {
    /// How often each kind of process is started.
    pub starts: usize,
    /// How long each kind is watched while it is idle; the same time before that is for coming to rest.
    pub idle: Duration,
}

/// A process that is started and watched.
struct Kind {
    word: &'static str,
    name: &'static str,
    beside: Others,
    with_neighbour: bool,
}

const RAW: &str = "10 zeromq sockets";

const KINDS: [Kind; 4] = [
    Kind { word: "station", name: "SCL, 10 gates, alone", beside: &[("zeromq", RAW)], with_neighbour: false },
    Kind { word: "station", name: "SCL, 10 gates, connected", beside: &[("zeromq", RAW)], with_neighbour: true },
    Kind { word: "sockets", name: RAW, beside: &[], with_neighbour: false },
    Kind { word: "nothing", name: "async runtime only", beside: &[], with_neighbour: false },
];

const COLUMNS: [Column; 4] = [
    Column::compared("open_p50_us"),
    Column::plain("open_max_us"),
    Column::compared("memory_kib"),
    Column::plain("wakeups_per_s"),
];

/// What came of one kind.
struct Measured {
    opening: Times,
    memory: f64,
    wakeups: f64,
}

/// Starts processes that open a component of ten gates, beside others that open raw sockets, and watches them.
///
/// # Errors
///
/// The folder for temporary files cannot be used, a process cannot be started, or `/proc` cannot be read.
pub fn measure_open(options: &Open) -> scl::Result<Report> {
    let runtime = start_runtime()?;
    let mut all = Vec::new();
    for _ in &KINDS {
        all.push(Measured { opening: Times::new()?, memory: 0.0, wakeups: 0.0 });
    }
    let starts = options.starts.max(1);
    for start in 1..=starts {
        for (kind, measured) in KINDS.iter().zip(&mut all) {
            let idle = (start == starts).then_some(options.idle);
            measured.play(&runtime, kind, idle)?;
        }
    }
    let mut report = Report::new("open");
    report.add(table(&all));
    report.note("memory is all that is resident, the program's own code included");
    report.note("of the `zeromq` sockets alone, the five that listen are bound and nothing is connected");
    Ok(report)
}

impl Measured {
    fn play(&mut self, runtime: &Runtime, kind: &Kind, idle: Option<Duration>) -> scl::Result<()> {
        let folder = scratch_folder()?;
        let folder = as_text(folder.path())?;
        let ready = if kind.with_neighbour { "connected" } else { "alone" };
        let mut process = OtherProcess::start(&["open", kind.word, folder, ready])?;
        self.opening.record(runtime.block_on(process.line())?.parse()?);
        let _neighbour = kind.with_neighbour.then(|| OtherProcess::start(&["open", "neighbour", folder, ready]));
        let _rests = runtime.block_on(process.line())?;
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

fn table(all: &[Measured]) -> Table {
    let mut table = Table::new("a process with a component of ten gates", &COLUMNS);
    for (kind, measured) in KINDS.iter().zip(all) {
        let opening = &measured.opening;
        let figures = vec![opening.quantile(0.5), opening.greatest(), measured.memory, measured.wakeups];
        table.add(Row::new(kind.name, figures).beside_all(kind.beside).with_times(opening));
    }
    table
}
