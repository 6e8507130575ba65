//! Log records of SCL on their way to Python's `logging`.
//!
//! A record may be made anywhere, for example by a thread that holds a gate's lock while the interpreter waits for that
//! lock. So logging never waits for the interpreter: records go into a queue, from which a thread of the package takes
//! them.

use crate::process::{detach, forget_threads};
use pyo3::prelude::*;
use std::cell::Cell;
use std::collections::VecDeque;
use std::fmt::{self, Write};
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tracing::field::{Field, Visit};
use tracing::subscriber::Interest;
use tracing::{Event, Level, Metadata, Subscriber};
use tracing_subscriber::layer::{Context, Layer, SubscriberExt};

/// How many records may wait; more are counted and dropped.
const CAPACITY: usize = 4096;

static QUEUE: Queue = Queue {
    records: Mutex::new(Records { waiting: VecDeque::new(), dropped: 0, ended: false }),
    added: Condvar::new(),
};
/// The lowest level that is queued, as a level of Python's `logging`.
static LEVEL: AtomicU8 = AtomicU8::new(0);

struct Queue {
    records: Mutex<Records>,
    added: Condvar,
}

struct Records {
    waiting: VecDeque<Record>,
    dropped: u64,
    /// Whether the thread that takes the records must end.
    ended: bool,
}

impl Queue {
    fn lock(&self) -> MutexGuard<'_, Records> {
        self.records.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A level of Python's `logging`, the module of SCL, the text.
type Record = (u8, &'static str, String);

/// Sends records to the queue from now on.
#[pyfunction]
pub(crate) fn log_start() {
    QUEUE.lock().ended = false;
    // Fails in a forked child, which has inherited the subscriber.
    let _already_set = tracing::subscriber::set_global_default(tracing_subscriber::registry().with(ToQueue));
}

/// Sets the lowest level that is queued, as a level of Python's `logging`.
#[pyfunction]
pub(crate) fn log_level(level: u8) {
    LEVEL.store(level, Ordering::Relaxed);
}

thread_local! {
    static HELD: Cell<Option<MutexGuard<'static, Records>>> = const { Cell::new(None) };
}

/// Locks the queue before a fork: a thread that held the lock would not exist in the child.
#[pyfunction]
pub(crate) fn log_hold(py: Python<'_>) -> PyResult<()> {
    detach(py, || HELD.set(Some(QUEUE.lock())))
}

/// Unlocks the queue after a fork, in the parent.
#[pyfunction]
pub(crate) fn log_release() {
    HELD.set(None);
}

/// Unlocks the queue after a fork, in the child, and forgets the parent's threads.
#[pyfunction]
pub(crate) fn forked() {
    HELD.set(None);
    forget_threads();
}

/// Waits for records, for at most `timeout` seconds. Returns false once the thread that takes them must end.
#[pyfunction]
pub(crate) fn log_wait(py: Python<'_>, timeout: f64) -> PyResult<bool> {
    let timeout = Duration::try_from_secs_f64(timeout).unwrap_or_default();
    detach(py, || {
        let is_idle = |records: &mut Records| records.waiting.is_empty() && !records.ended;
        let waited = QUEUE.added.wait_timeout_while(QUEUE.lock(), timeout, is_idle);
        !waited.unwrap_or_else(PoisonError::into_inner).0.ended
    })
}

/// Ends the thread that takes records.
#[pyfunction]
pub(crate) fn log_end(py: Python<'_>) -> PyResult<()> {
    detach(py, || {
        QUEUE.lock().ended = true;
        QUEUE.added.notify_all();
    })
}

/// Takes all records, and the number of those that were dropped.
#[pyfunction]
pub(crate) fn log_take(py: Python<'_>) -> PyResult<(Vec<Record>, u64)> {
    detach(py, || {
        let mut records = QUEUE.lock();
        (records.waiting.drain(..).collect(), std::mem::take(&mut records.dropped))
    })
}

/// Returns the corresponding level of Python's `logging`.
fn rank(level: &Level) -> u8 {
    match *level {
        Level::ERROR => 40,
        Level::WARN => 30,
        Level::INFO => 20,
        Level::DEBUG => 10,
        Level::TRACE => 5,
    }
}

struct ToQueue;

impl<S: Subscriber> Layer<S> for ToQueue {
    fn enabled(&self, metadata: &Metadata<'_>, _: Context<'_, S>) -> bool {
        rank(metadata.level()) >= LEVEL.load(Ordering::Relaxed) && metadata.target().starts_with("scl")
    }

    fn register_callsite(&self, _: &'static Metadata<'static>) -> Interest {
        // Do not cache the result: the level follows Python's, which may change.
        Interest::sometimes()
    }

    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        let mut text = Text::default();
        event.record(&mut text);
        let record = (rank(event.metadata().level()), event.metadata().target(), text.message + &text.fields);
        let mut records = QUEUE.lock();
        if records.waiting.len() < CAPACITY {
            records.waiting.push_back(record);
        } else {
            records.dropped += 1;
        }
        QUEUE.added.notify_one();
    }
}

/// The message, and the other fields as ` key=value`.
#[derive(Default)]
struct Text {
    message: String,
    fields: String,
}

impl Visit for Text {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        let _infallible = match field.name() {
            "message" => write!(self.message, "{value:?}"),
            name => write!(self.fields, " {name}={value:?}"),
        };
    }
}
