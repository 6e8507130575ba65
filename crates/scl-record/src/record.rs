//! Recording: from the taps of a running system into MCAP files.
//!
//! One thread reads the taps (`collector`) and never waits for the disk; another one writes (`storage`). Between them
//! is a queue with a limit in bytes. Messages that do not fit into the queue, or that a gate dropped because the
//! recorder read too slowly, are counted as lost. The gates are never delayed.

mod collector;
mod contents;
mod continuous;
mod disk_room;
mod file;
mod file_names;
mod gate;
mod losses;
mod missed;
mod options;
mod parameters;
mod plans;
mod queue;
mod report;
mod ring;
mod storage;
mod trigger;
mod write_error;

pub use contents::AttachedFile;
pub use continuous::Split;
pub use file::WrittenFile;
pub(crate) use file::options;
pub use options::{Options, RingOptions};
pub use report::Report;
pub use trigger::trigger;
pub(crate) use write_error::text_of;

use crate::format::PARAMETERS;
use collector::Collector;
use contents::Contents;
use continuous::Continuous;
use file_names::{FileNames, Numbering};
use missed::Missed;
use options::Notes;
use parameters::Parameters;
use plans::Plans;
use queue::queue;
use ring::Ring;
use scl_observe::{Selection, StopSignals, System, Taps, block_on, watch_signal};
use scl_terminal::{Problem, escape};
use std::sync::Arc;
use std::thread;
use std::time::Instant;
use storage::{Outcome, Progress, Store, store};
use tokio::signal::unix::SignalKind;
use tokio::sync::oneshot;
use trigger::TriggerListener;

/// Records until SIGINT, SIGTERM or SIGHUP, until the time is over, or until the disk is full.
///
/// # Errors
/// A gate is unknown, or the first file cannot be created. If recording ends early, the report says why.
pub fn record(system: &System, options: &Options) -> Result<Report, Problem> {
    block_on(record_async(system, options))
}

async fn record_async(system: &System, options: &Options) -> Result<Report, Problem> {
    // Watch for signals first, so that an early one ends the recording instead of killing the process.
    let signals = (StopSignals::watch()?, watch_signal(SignalKind::user_defined1())?);
    let notes = Notes::new();
    let selection = Selection::new(system, &options.gates, &options.exclude, &options.topology)?;
    let (plans, plan) = Plans::of(system);
    let mut parameters = Parameters::default();
    let contents = Contents {
        system: system.name().to_owned(),
        attached: options.attached.clone(),
        plan,
        latest: parameters.update(system, &plans).map(|values| (PARAMETERS, values)).into_iter().collect(),
        gates: Vec::new(),
    };
    let (destination, trigger) = open_store(system, options, &contents, &notes)?;
    selection
        .waiting()
        .iter()
        .for_each(|name| notes.say(&format!("`{name}` is not running; recording it once it has started")));

    let taps = Taps::follow_all(system, move |gate| selection.includes(gate));
    let (queue, receiver) = queue(options.memory);
    let progress = Arc::new(Progress::default());
    let (stopped_sender, stopped) = oneshot::channel();
    let storage = thread::Builder::new().name("storage".to_owned()).spawn({
        let progress = Arc::clone(&progress);
        move || store(destination, contents, &receiver, &progress, stopped_sender)
    });
    let storage = storage.map_err(|error| Problem::new(format!("cannot start a thread: {error}")))?;
    let started = Instant::now();
    let (losses, initial) = (Vec::new(), taps.gates().len());
    let (missed, unconnected) = (Missed::start(system, &plans), initial);
    let collector =
        Collector { system, taps, queue, trigger, notes, losses, plans, parameters, missed, initial, unconnected };
    collector.run(signals, options.run_for, &progress, stopped).await;
    let duration = started.elapsed();
    let Outcome { files, deleted, totals, problem } =
        storage.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    Ok(Report { totals, duration, files, deleted, problem })
}

/// Creates the first file, or the ring and the socket at which it is triggered.
fn open_store(
    system: &System,
    options: &Options,
    contents: &Contents,
    notes: &Notes,
) -> Result<(Store, Option<TriggerListener>), Problem> {
    let is_split = options.split.bytes.is_some() || options.split.time.is_some();
    let numbering = if is_split { Numbering::All } else { Numbering::FromSecond };
    let names = FileNames::new(options.output.as_deref(), system.name(), numbering, options.overwrite)?;
    let name = escape(system.name());
    match options.ring {
        None => {
            let continuous = Continuous::start(names, options.split, options.sync, contents)?;
            let path = continuous.path().map(|path| path.to_string_lossy().into_owned()).unwrap_or_default();
            notes.say(&format!("recording `{name}` to `{}`; Ctrl-C stops", escape(&path)));
            Ok((Store::Continuous(Box::new(continuous)), None))
        }
        Some(ring) => {
            let trigger = TriggerListener::open(system)?;
            let id = std::process::id();
            notes.say(&format!(
                "keeping the last {:?} of `{name}` in memory; \
                 `scl record --trigger` or SIGUSR1 to process {id} writes them",
                ring.window
            ));
            Ok((Store::Ring(Ring::new(names, ring.window, options.memory, ring.save_at_end)), Some(trigger)))
        }
    }
}
