//! The thread that writes: it takes messages from the queue, and writes them to files or keeps them in the ring.

use super::contents::Contents;
use super::continuous::Continuous;
use super::file::WrittenFile;
use super::queue::{Item, QueueReceiver};
use super::ring::Ring;
use crate::format::{GateTotals, Totals};
use bytes::Bytes;
use scl_observe::ObservedGate;
use scl_terminal::Problem;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use tokio::sync::oneshot;

/// How often the queue is polled while few messages arrive.
const POLL: Duration = Duration::from_millis(100);

/// A command to the storage, queued in order with the messages.
pub(crate) enum Command {
    /// A new gate, which gets the next number.
    Gate(ObservedGate),
    /// The plans of all components that were seen.
    Plan(Bytes),
    /// What has changed, and the name of its attachment.
    Latest(&'static str, Bytes),
    /// The number of a gate, and of its messages lost after the last recorded one.
    Lost(usize, u64),
    /// Write the ring to a file and send the result; without a ring, flush the current file.
    Save(SaveAnswer),
}

/// Receives the result of [`Command::Save`]: the written file, or `None` without a ring.
pub(crate) type SaveAnswer = oneshot::Sender<Result<Option<WrittenFile>, Problem>>;

/// Where messages go.
pub(crate) enum Store {
    Continuous(Box<Continuous>),
    Ring(Ring),
}

/// The result of a recording.
#[derive(Debug, Default)]
pub(crate) struct Outcome {
    /// The files that were written and not deleted by `--keep`.
    pub(crate) files: Vec<WrittenFile>,
    /// Number of files deleted by `--keep`.
    pub(crate) deleted: usize,
    pub(crate) totals: Totals,
    /// Why the recording ended early.
    pub(crate) problem: Option<Problem>,
}

/// Figures of a recording while it runs.
#[derive(Debug, Default)]
pub(crate) struct Progress {
    pub(crate) messages: AtomicU64,
    pub(crate) lost: AtomicU64,
    pub(crate) bytes: AtomicU64,
}

/// Stores the messages from the queue until its end, or until a file cannot be written. `stopped` is dropped as soon as
/// nothing more is stored.
pub(crate) fn store(
    mut store: Store,
    mut contents: Contents,
    receiver: &QueueReceiver<Command>,
    progress: &Arc<Progress>,
    stopped: oneshot::Sender<()>,
) -> Outcome {
    let mut totals = Totals { system: contents.system.clone(), ..Totals::default() };
    let mut problem = None;
    while let Some(items) = receiver.take(POLL) {
        problem = store_items(&mut store, &mut contents, items, receiver, &mut totals).err();
        progress.update(&totals, &store);
        if problem.is_some() {
            break;
        }
    }
    drop(stopped);
    // After a failure, everything that is still in the queue is lost.
    while let Some(items) = receiver.take(POLL) {
        items.iter().for_each(|item| count_as_lost(item, &contents, &mut totals));
    }
    let (files, deleted, at_end) = match store {
        Store::Continuous(continuous) => continuous.finish(),
        Store::Ring(ring) => ring.finish(&contents),
    };
    Outcome { files, deleted, totals, problem: problem.or(at_end) }
}

fn store_items(
    store: &mut Store,
    contents: &mut Contents,
    items: VecDeque<Item<Command>>,
    receiver: &QueueReceiver<Command>,
    totals: &mut Totals,
) -> Result<(), Problem> {
    let mut items = items.into_iter();
    let stored = items.by_ref().try_for_each(|item| match item {
        Item::Message(message) => {
            let (gate, lost, memory) = (message.gate, message.lost_before, message.memory());
            let stored = match store {
                Store::Continuous(continuous) => continuous.write(message, contents),
                Store::Ring(ring) => {
                    ring.push(message);
                    Ok(())
                }
            };
            receiver.release(memory);
            let totals = totals_of(totals, contents, gate);
            totals.lost += lost + u64::from(stored.is_err());
            totals.recorded += u64::from(stored.is_ok());
            stored
        }
        Item::Command(command) => handle(store, contents, command, totals),
    });
    // Items are left only after a failure.
    items.for_each(|item| count_as_lost(&item, contents, totals));
    stored?;
    match store {
        Store::Continuous(continuous) => continuous.keep_up(contents),
        Store::Ring(_) => Ok(()),
    }
}

fn handle(store: &mut Store, contents: &mut Contents, command: Command, totals: &mut Totals) -> Result<(), Problem> {
    match command {
        Command::Gate(gate) => {
            totals.gates.entry(gate.name()).or_default();
            contents.gates.push(gate);
            match store {
                Store::Continuous(continuous) => continuous.add_last_gate(contents),
                Store::Ring(_) => Ok(()),
            }
        }
        Command::Plan(plan) => {
            contents.plan = plan;
            match store {
                Store::Continuous(continuous) => continuous.attach_plan(contents),
                Store::Ring(_) => Ok(()),
            }
        }
        Command::Latest(name, latest) => {
            let attached = match store {
                Store::Continuous(continuous) => continuous.attach_latest(name, &latest),
                Store::Ring(_) => Ok(()),
            };
            contents.latest.insert(name, latest);
            attached
        }
        Command::Lost(gate, lost) => {
            totals_of(totals, contents, gate).lost += lost;
            if let Store::Continuous(continuous) = store {
                continuous.count_lost(gate, lost);
            }
            Ok(())
        }
        Command::Save(answer) => {
            let saved = match store {
                Store::Continuous(continuous) => continuous.flush().map(|()| None),
                Store::Ring(ring) => ring.save(contents).map(Some),
            };
            let flushed = match (&saved, store) {
                (Err(problem), Store::Continuous(_)) => Err(problem.clone()),
                // A ring buffer keeps recording: there may be room the next time.
                _ => Ok(()),
            };
            let _asker_is_gone = answer.send(saved);
            flushed
        }
    }
}

fn totals_of<'t>(totals: &'t mut Totals, contents: &Contents, gate: usize) -> &'t mut GateTotals {
    totals.gates.entry(contents.gates[gate].name()).or_default()
}

fn count_as_lost(item: &Item<Command>, contents: &Contents, totals: &mut Totals) {
    let (gate, lost) = match item {
        Item::Message(message) => (message.gate, 1 + message.lost_before),
        Item::Command(Command::Lost(gate, lost)) => (*gate, *lost),
        Item::Command(_) => return,
    };
    // A gate that was added after the failure is not known here.
    if gate < contents.gates.len() {
        totals_of(totals, contents, gate).lost += lost;
    }
}

impl Progress {
    fn update(&self, totals: &Totals, store: &Store) {
        let bytes = match store {
            Store::Continuous(continuous) => continuous.bytes(),
            Store::Ring(ring) => ring.bytes() as u64,
        };
        self.messages.store(totals.gates.values().map(|gate| gate.recorded).sum(), Ordering::Relaxed);
        self.lost.store(totals.gates.values().map(|gate| gate.lost).sum(), Ordering::Relaxed);
        self.bytes.store(bytes, Ordering::Relaxed);
    }
}
