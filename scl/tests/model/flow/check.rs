//! Comparing the gates with the model.

use super::model::Connection;
use super::stage::Stage;
use super::transit::Promise;
use crate::model::runner::Outcome;
use scl::{GateStats, PeerStats};

impl Stage {
    /// After each step: the gates count what the model counts.
    pub(super) fn check(&mut self) -> Outcome {
        let sender = self.source.as_mut().map(|source| source.gate().stats());
        let readers: Vec<_> = self.readers.iter().map(|reader| reader.as_ref().map(|gate| gate.stats())).collect();
        let mut model = self.model.lock();
        model.verdict()?;
        if let Some((stats, peers)) = sender {
            check_sender(&stats, &model.connections)?;
            for ((stats, connection), reader) in peers.iter().zip(&mut model.connections).zip(0..) {
                check_peer(stats, connection).map_err(|reason| format!("account of reader {reader}: {reason}"))?;
            }
        }
        for ((stats, connection), reader) in readers.into_iter().zip(&model.connections).zip(0..) {
            if let Some(stats) = stats {
                check_reader(&stats, connection).map_err(|reason| format!("reader {reader}: {reason}"))?;
            }
        }
        Ok(())
    }

    /// After the tasks of gates in memory have run: everything that could move has moved, and waiting calls were woken.
    pub(super) fn check_progress(&self) -> Outcome {
        let model = self.model.lock();
        for ((connection, news), reader) in model.connections.iter().zip(&self.news).zip(0..) {
            let Connection { outbox, transit, inbox, .. } = connection;
            if self.source.is_some() && outbox.is_connected() != transit.has_reader() {
                return Err(format!(
                    "reader {reader} is there: {}; the sender does not know that",
                    transit.has_reader()
                ));
            }
            let (queued, due) = (&outbox.waiting, transit.due());
            if outbox.is_connected() && !queued.is_empty() && (due == 0 || !inbox.waits()) {
                return Err(format!("reader {reader} takes more, and {queued:?} wait for it"));
            }
            if transit.has_reader() && due > 0 && !inbox.waits() {
                return Err(format!("{due} messages have arrived, and reader {reader} has not taken them in"));
            }
            let has_news = due > 0 || !inbox.waiting.is_empty();
            if news.as_ref().is_some_and(|news| has_news && !news.is_set()) {
                return Err(format!("reader {reader} waits, a message has arrived, and the reader was not woken"));
            }
        }
        if self.room.as_ref().is_some_and(|room| !model.would_wait() && !room.is_set()) {
            return Err("the sender waits, there is room, and the sender was not woken".to_owned());
        }
        Ok(())
    }
}

/// After a call that applies the queue to everything that has arrived: nothing is left in the memory transport.
pub(super) fn check_taken_in(promise: Promise, connection: &Connection) -> Outcome {
    match connection.transit.due() {
        left @ 1.. if promise.is_exact() => Err(format!("{left} messages have arrived and were not taken in")),
        _ => Ok(()),
    }
}

fn check_sender(stats: &GateStats, connections: &[Connection]) -> Outcome {
    let sum = |count: fn(&Connection) -> u64| connections.iter().map(count).sum::<u64>();
    same("sent", stats.sent, sum(|one| one.outbox.handed))?;
    same("lost", stats.lost, sum(|one| one.outbox.lost))?;
    same("replaced", stats.replaced, sum(|one| one.outbox.replaced))?;
    same("dropped_oldest", stats.dropped_oldest, sum(|one| one.outbox.dropped_oldest))?;
    same("dropped_newest", stats.dropped_newest, sum(|one| one.outbox.dropped_newest))?;
    same("waiting", stats.waiting as u64, sum(|one| one.outbox.waiting.len() as u64 + one.not_received))?;
    same("peers", stats.peers as u64, sum(|one| u64::from(one.outbox.is_connected())))
}

fn check_peer(stats: &PeerStats, connection: &mut Connection) -> Outcome {
    let dropped = stats.replaced + stats.dropped_oldest + stats.dropped_newest;
    same("published", stats.published, stats.taken + dropped + stats.lost + stats.waiting)?;
    let outbox = &connection.outbox;
    same("taken", stats.taken, outbox.handed - outbox.lost - connection.not_received)?;
    let before = std::mem::replace(&mut connection.taken, stats.taken);
    if stats.taken < before {
        return Err(format!("`taken` falls from {before} to {}", stats.taken));
    }
    same("connected", u64::from(stats.connected), u64::from(outbox.is_connected()))
}

fn check_reader(stats: &GateStats, connection: &Connection) -> Outcome {
    let inbox = &connection.inbox;
    same("received", stats.received, inbox.received)?;
    same("replaced", stats.replaced, inbox.replaced)?;
    same("dropped_oldest", stats.dropped_oldest, inbox.dropped_oldest)?;
    same("dropped_newest", stats.dropped_newest, inbox.dropped_newest)?;
    same("rejected", stats.rejected, 0)?;
    same("waiting", stats.waiting as u64, inbox.waiting.len() as u64)
}

fn same(what: &str, counted: u64, expected: u64) -> Outcome {
    if counted == expected { Ok(()) } else { Err(format!("`{what}` is {counted} instead of {expected}")) }
}
