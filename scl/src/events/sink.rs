//! The gates that events are sent to, each with the thread that sends.

use super::{Event, EventGate};
use std::cell::Cell;
use std::fmt::{Debug, Write};
use std::io;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant, SystemTime};
use tracing::Level;
use tracing::field::{Field, Visit};
use tracing::level_filters::LevelFilter;

/// Maximum number of events that wait for a thread.
const MOST_WAITING: usize = 1_024;

/// How often it is logged that events were not sent; all of them are counted.
const TOLD_EVERY: Duration = Duration::from_secs(1);

static SINKS: RwLock<Vec<Sink>> = RwLock::new(Vec::new());

thread_local! {
    /// Whether this thread sends events: its own are not sent.
    static SENDS: Cell<bool> = const { Cell::new(false) };
}

/// What a thread is given.
enum Item {
    Event(Event),
    /// All events before this one are done.
    Flush(SyncSender<()>),
}

struct Sink {
    level: Level,
    /// The names under which SCL's own events speak of the gate.
    names: Vec<String>,
    queue: SyncSender<Item>,
    dropped: Arc<AtomicU64>,
    thread: JoinHandle<()>,
}

fn sinks() -> RwLockReadGuard<'static, Vec<Sink>> {
    SINKS.read().unwrap_or_else(PoisonError::into_inner)
}

/// The least important level that any gate gets.
pub(super) fn level() -> LevelFilter {
    sinks().iter().map(|sink| LevelFilter::from_level(sink.level)).max().unwrap_or(LevelFilter::OFF)
}

pub(super) fn add<G: EventGate>(
    gate: G,
    level: Level,
    message: impl FnMut(&Event) -> G::Message + Send + 'static,
) -> io::Result<()> {
    let (queue, items) = sync_channel(MOST_WAITING);
    let dropped = Arc::new(AtomicU64::new(0));
    let (names, counted) = (gate.names(), Arc::clone(&dropped));
    let thread = thread::Builder::new().name("scl-events".to_owned());
    let thread = thread.spawn(move || run(gate, message, &items, &counted))?;
    let sink = Sink { level, names, queue, dropped, thread };
    SINKS.write().unwrap_or_else(PoisonError::into_inner).push(sink);
    // From now on, more events are wanted than before.
    tracing::callsite::rebuild_interest_cache();
    Ok(())
}

/// Sends until [`end`] drops the other end of the queue.
fn run<G: EventGate>(
    mut gate: G,
    mut message: impl FnMut(&Event) -> G::Message,
    items: &Receiver<Item>,
    dropped: &AtomicU64,
) {
    SENDS.set(true);
    let mut last_told: Option<Instant> = None;
    for item in items {
        let done = match item {
            Item::Event(event) => {
                if !gate.offer(&message(&event)) {
                    dropped.fetch_add(1, Ordering::Relaxed);
                }
                None
            }
            Item::Flush(done) => Some(done),
        };
        let may_tell = done.is_some() || last_told.is_none_or(|last| last.elapsed() >= TOLD_EVERY);
        let number = if may_tell { dropped.swap(0, Ordering::Relaxed) } else { 0 };
        if number > 0 {
            last_told = Some(Instant::now());
            tracing::warn!("{number} events were not sent: more were logged than could be sent");
        }
        done.into_iter().for_each(|done| _ = done.try_send(()));
    }
}

/// Gives an event to the threads of the gates that want it.
pub(super) fn offer(event: &tracing::Event<'_>) {
    // A thread that is ending has no value any more, and sends no events.
    if SENDS.try_with(Cell::get).unwrap_or(false) {
        return;
    }
    let metadata = event.metadata();
    let mut text = Text::default();
    event.record(&mut text);
    let event = Event {
        time: SystemTime::now(),
        level: *metadata.level(),
        target: metadata.target(),
        text: format!("{}{}", text.message, text.fields).trim_start().to_owned(),
    };
    let is_own = event.target.starts_with("scl");
    for sink in sinks().iter().filter(|sink| event.level <= sink.level) {
        if is_own && text.names.iter().any(|name| sink.names.contains(name)) {
            continue;
        }
        if sink.queue.try_send(Item::Event(event.clone())).is_err() {
            sink.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }
}

/// Waits until each thread has done what was given to it before.
pub(super) fn flush(timeout: Duration) -> bool {
    let start = Instant::now();
    let queues: Vec<SyncSender<Item>> = sinks().iter().map(|sink| sink.queue.clone()).collect();
    queues.into_iter().all(|queue| is_done(&queue, timeout.saturating_sub(start.elapsed())))
}

/// Flushes, and drops the gates.
pub(super) fn end(timeout: Duration) -> bool {
    let start = Instant::now();
    let sinks = std::mem::take(&mut *SINKS.write().unwrap_or_else(PoisonError::into_inner));
    if sinks.is_empty() {
        return true;
    }
    tracing::callsite::rebuild_interest_cache();
    let mut all_done = true;
    for Sink { queue, thread, .. } in sinks {
        let is_done = is_done(&queue, timeout.saturating_sub(start.elapsed()));
        drop(queue);
        // All that is left for the thread is to drop the gate.
        all_done &= is_done && thread.join().is_ok();
    }
    all_done
}

/// Waits until a thread has done what was given to it before.
fn is_done(queue: &SyncSender<Item>, timeout: Duration) -> bool {
    let start = Instant::now();
    let (done, wait) = sync_channel(1);
    let mut item = Item::Flush(done);
    // `SyncSender` cannot wait with a limit.
    while let Err(error) = queue.try_send(item) {
        item = match error {
            TrySendError::Full(item) if start.elapsed() < timeout => item,
            _ => return false,
        };
        thread::sleep(Duration::from_millis(1));
    }
    wait.recv_timeout(timeout.saturating_sub(start.elapsed())).is_ok()
}

/// An event as text.
#[derive(Default)]
struct Text {
    message: String,
    fields: String,
    /// The gates and endpoints that it is about.
    names: Vec<String>,
}

impl Visit for Text {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        match field.name() {
            "message" => self.message = format!("{value:?}"),
            name => {
                if matches!(name, "gate" | "endpoint") {
                    self.names.push(format!("{value:?}"));
                }
                // Writing to a `String` cannot fail.
                let _infallible = write!(self.fields, " {name}={value:?}");
            }
        }
    }
}
