//! How long a message takes to another process and back.

mod ball;
mod components;
#[cfg(feature = "libzmq")]
mod libzmq;
mod wall;

pub(crate) use wall::play_wall;

use crate::AllocationCount;
use crate::histogram::Times;
use crate::lengths::check_lengths;
use crate::processes::{OtherProcess, as_text, scratch_folder, start_runtime};
use crate::report::{Column, Others, Report, Row, Table};
use ball::Ball;
use scl::bytes::Bytes;
use std::ops::RangeInclusive;
use tokio::runtime::Runtime;

/// Messages of one way before it is the next one's turn.
const BATCH: usize = 500;

/// What [`measure_roundtrip`] is asked for.
#[derive(Debug, Clone)]
pub struct Roundtrip {
    /// The lengths of the messages, in bytes, one table each; within [`Roundtrip::BYTES`].
    pub bytes: Vec<usize>,
    /// How many messages of each length go each way there and back.
    pub messages: usize,
    /// Adds how many allocations of this process a message takes.
    pub allocations: Option<AllocationCount>,
}

impl Roundtrip {
    /// The lengths that messages may have. Some ten processes keep a few of them each in memory.
    pub const BYTES: RangeInclusive<usize> = 1..=16 << 20;
}

/// A way there and back: `word` names it between the processes.
struct Way {
    word: &'static str,
    name: &'static str,
    beside: Others,
}

const fn way(word: &'static str, name: &'static str, beside: Others) -> Way {
    Way { word, name, beside }
}

const SCL_PUBLISH: &str = "SCL pub/sub";
const SCL_CALL: &str = "SCL req/rep";
const RAW_PUBLISH: &str = "zeromq XPUB/SUB";
const RAW_CALL: &str = "zeromq DEALER/ROUTER";
const LIBZMQ_PUBLISH: &str = "libzmq XPUB/SUB";
const LIBZMQ_CALL: &str = "libzmq REQ/REP";

const WAYS: &[Way] = &[
    way("scl-publish", SCL_PUBLISH, &[("zeromq", RAW_PUBLISH), ("libzmq", LIBZMQ_PUBLISH)]),
    way(
        "scl-publish-blocking",
        "SCL pub/sub blocking",
        &[("zeromq", RAW_PUBLISH), ("libzmq", LIBZMQ_PUBLISH), ("async", SCL_PUBLISH)],
    ),
    way("raw-publish", RAW_PUBLISH, &[("libzmq", LIBZMQ_PUBLISH)]),
    #[cfg(feature = "libzmq")]
    way("libzmq-publish-blocking", LIBZMQ_PUBLISH, &[("zeromq", RAW_PUBLISH)]),
    way("scl-call", SCL_CALL, &[("zeromq", RAW_CALL), ("libzmq", LIBZMQ_CALL)]),
    way(
        "scl-call-blocking",
        "SCL req/rep blocking",
        &[("zeromq", RAW_CALL), ("libzmq", LIBZMQ_CALL), ("async", SCL_CALL)],
    ),
    way("raw-call", RAW_CALL, &[("libzmq", LIBZMQ_CALL)]),
    #[cfg(feature = "libzmq")]
    way("libzmq-call-blocking", LIBZMQ_CALL, &[("zeromq", RAW_CALL)]),
    way("unix", "Unix socket, tokio", &[]),
    way("unix-blocking", "Unix socket, blocking", &[]),
];

/// A way in use, with its other process.
struct Course {
    way: &'static Way,
    ball: Ball,
    times: Times,
    allocations: u64,
    recorded: usize,
    _wall: OtherProcess,
}

/// Measures the time to another process and back for every way, beside each other.
///
/// # Errors
///
/// A length outside [`Roundtrip::BYTES`]; the folder for temporary files cannot be used, a process cannot be started,
/// or a connection fails.
pub fn measure_roundtrip(options: &Roundtrip) -> scl::Result<Report> {
    check_lengths(&options.bytes, Roundtrip::BYTES)?;
    let mut report = Report::new("roundtrip");
    let runtime = start_runtime()?;
    for &bytes in &options.bytes {
        report.add(measure_length(&runtime, bytes, options)?);
    }
    Ok(report)
}

fn measure_length(runtime: &Runtime, bytes: usize, options: &Roundtrip) -> scl::Result<Table> {
    let folder = scratch_folder()?;
    let mut courses = Vec::new();
    for way in WAYS {
        let (ball, wall) = Ball::start(runtime, way.word, as_text(folder.path())?, bytes)?;
        courses.push(Course { way, ball, times: Times::new()?, allocations: 0, recorded: 0, _wall: wall });
    }
    let payload = Bytes::from(vec![7; bytes]);
    for batch in batches(options.messages) {
        for course in &mut courses {
            course.play(runtime, &payload, batch, options.allocations)?;
        }
    }
    Ok(table(bytes, &courses, options.allocations.is_some()))
}

fn batches(messages: usize) -> impl Iterator<Item = usize> {
    (0..messages).step_by(BATCH).map(move |done| BATCH.min(messages - done))
}

impl Course {
    /// One batch, after a tenth of it that only warms up again what the others cooled down.
    fn play(
        &mut self,
        runtime: &Runtime,
        payload: &Bytes,
        messages: usize,
        count: Option<AllocationCount>,
    ) -> scl::Result<()> {
        self.ball.throw(runtime, payload, messages.div_ceil(10), &mut |_| {})?;
        let allocated = count.map(|count| count());
        let times = &mut self.times;
        self.ball.throw(runtime, payload, messages, &mut |nanoseconds| times.record(nanoseconds))?;
        if let (Some(count), Some(before)) = (count, allocated) {
            self.allocations += count() - before;
        }
        self.recorded += messages;
        Ok(())
    }
}

fn table(bytes: usize, courses: &[Course], counted: bool) -> Table {
    let mut columns = vec![Column::compared("p50_us"), Column::compared("p99_us")];
    if counted {
        columns.push(Column::plain("allocations"));
    }
    let mut table = Table::new(format!("round trip of {bytes} bytes between two processes"), &columns);
    for course in courses {
        let mut figures = vec![course.times.quantile(0.5), course.times.quantile(0.99)];
        if counted {
            figures.push(course.allocations as f64 / course.recorded.max(1) as f64);
        }
        let row = Row::new(course.way.name, figures).beside_all(course.way.beside);
        table.add(row.with_times(&course.times));
    }
    table
}
