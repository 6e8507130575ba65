//! Comparing the gates with the model.

use super::model::Connection;
use super::stage::Stage;
use super::way::Promise;
use crate::trial::Outcome;
use scl::GateStats;

impl Stage {
    /// After each step: what the gates count is what the model counts.
    pub(super) fn check(&self) -> Outcome {
        let (sender, readers) = (self.sender.as_ref().map(|gate| gate.stats()), self.readers.iter());
        let readers: Vec<_> = readers.map(|reader| reader.as_ref().map(|gate| gate.stats())).collect();
        let model = self.book.model();
        model.verdict()?;
        if let Some(stats) = sender {
            check_sender(&stats, &model.connections)?;
        }
        for ((stats, connection), place) in readers.into_iter().zip(&model.connections).zip(0..) {
            if let Some(stats) = stats {
                check_reader(&stats, connection).map_err(|reason| format!("reader {place}: {reason}"))?;
            }
        }
        Ok(())
    }

    /// After the tasks have run, of connections in memory: who could move on has done so, or was woken to do so.
    pub(super) fn check_moved(&self) -> Outcome {
        let model = self.book.model();
        for ((connection, news), place) in model.connections.iter().zip(&self.news).zip(0..) {
            let Connection { held, way, .. } = connection;
            if self.sender.is_some() && held.present != way.has_reader() {
                return Err(format!("reader {place} is there: {}; the sender knows nothing of it", way.has_reader()));
            }
            if held.present && !held.waiting.is_empty() && way.due() == 0 {
                return Err(format!("reader {place} has nothing on the way, and {:?} wait for it", held.waiting));
            }
            if news.as_ref().is_some_and(|news| way.due() > 0 && !news.is_raised()) {
                return Err(format!("reader {place} waits, something has arrived, and it was not woken"));
            }
        }
        if self.room.as_ref().is_some_and(|room| !model.makes_wait() && !room.is_raised()) {
            return Err("the sender waits, there is room, and it was not woken".to_owned());
        }
        Ok(())
    }
}

/// After a call that applies the queue to everything that has arrived, of a connection in memory: nothing is left.
pub(super) fn check_taken_in(promise: Promise, everything: bool, connection: &Connection) -> Outcome {
    match connection.way.due() {
        left @ 1.. if everything && promise.is_exact() => Err(format!("{left} messages had arrived and were left out")),
        _ => Ok(()),
    }
}

fn check_sender(stats: &GateStats, connections: &[Connection]) -> Outcome {
    let sum = |count: fn(&Connection) -> u64| connections.iter().map(count).sum::<u64>();
    same("sent", stats.sent, sum(|one| one.held.sent))?;
    same("dropped_oldest", stats.dropped_oldest, sum(|one| one.held.dropped_oldest))?;
    same("dropped_newest", stats.dropped_newest, sum(|one| one.held.dropped_newest))?;
    same("waiting", stats.waiting as u64, sum(|one| one.held.waiting.len() as u64))?;
    same("peers", stats.peers as u64, sum(|one| u64::from(one.held.present)))
}

fn check_reader(stats: &GateStats, connection: &Connection) -> Outcome {
    let inbox = &connection.inbox;
    same("received", stats.received, inbox.received)?;
    same("dropped_oldest", stats.dropped_oldest, inbox.dropped_oldest)?;
    same("dropped_newest", stats.dropped_newest, inbox.dropped_newest)?;
    same("rejected", stats.rejected, 0)?;
    same("waiting", stats.waiting as u64, inbox.waiting.len() as u64)
}

fn same(what: &str, counted: u64, expected: u64) -> Outcome {
    if counted == expected { Ok(()) } else { Err(format!("`{what}` is {counted} instead of {expected}")) }
}
