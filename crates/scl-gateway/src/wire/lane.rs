//! Traffic to one host: a fair queue of what its routes send, and a window of bytes in flight.
//!
//! The network library silently drops what does not fit into its own queues, so a lane gives it no more than they hold:
//! marks are sent behind the bytes, and when the other gateway echoes a mark, the bytes before it have left. Large
//! messages are sent in pieces, the routes take turns, and on a slow link the window shrinks, so that small messages of
//! other routes do not wait long.

use std::collections::{HashMap, VecDeque};
use std::time::{Duration, Instant};

use bytes::Bytes;

use super::command::EndId;
use super::header::{Header, Kind};

/// Two pieces with everything around them fit into a batch of the network library (64 KiB).
const PIECE: usize = 30 * 1024;
/// The queue of the network library has room for 16 batches; half of it is always usable, however badly the batches are
/// filled.
pub(super) const LARGEST_WINDOW: usize = 384 * 1024;
const SMALLEST_WINDOW: usize = 64 * 1024;
const BETWEEN_MARKS: usize = 32 * 1024;
/// What a message costs besides its payload.
const OVERHEAD: usize = 100;
/// The window shrinks if the round trip of a mark takes this much longer than the link's own delay.
const LONGEST_WAIT: Duration = Duration::from_millis(100);
const REPEAT_MARK: Duration = Duration::from_secs(1);

#[derive(Debug, Default)]
pub(super) struct Lane {
    turns: VecDeque<EndId>,
    queues: HashMap<EndId, VecDeque<(Header, Bytes, usize)>>,
    is_open: bool,
    window: usize,
    unmarked: usize,
    marks: VecDeque<Mark>,
    last_mark: u64,
    round_trip: Option<Duration>,
    repeat_at: Option<Instant>,
    pause: Duration,
}

#[derive(Debug)]
struct Mark {
    number: u64,
    bytes: usize,
    sent: Instant,
}

/// What to send next.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Emission {
    Piece { id: EndId, header: Header, payload: Bytes },
    Mark(u64),
}

impl Lane {
    pub(super) fn new() -> Self {
        Lane { window: LARGEST_WINDOW, pause: REPEAT_MARK, ..Lane::default() }
    }

    /// Opens the lane when the host connects, or closes it when the host disconnects. Forgets what was in flight.
    pub(super) fn set_open(&mut self, is_open: bool) {
        self.is_open = is_open;
        self.window = LARGEST_WINDOW;
        (self.unmarked, self.round_trip, self.repeat_at) = (0, None, None);
        self.marks.clear();
    }

    pub(super) fn push(&mut self, id: EndId, header: Header, message: Bytes) {
        let queue = self.queues.entry(id).or_default();
        if queue.is_empty() {
            self.turns.push_back(id);
        }
        queue.push_back((header, message, 0));
    }

    pub(super) fn clear(&mut self, id: EndId) {
        if self.queues.remove(&id).is_some() {
            self.turns.retain(|turn| *turn != id);
        }
    }

    /// The next piece or mark, if the window allows it.
    pub(super) fn next(&mut self, now: Instant) -> Option<Emission> {
        if !self.is_open {
            return None;
        }
        if self.unmarked >= BETWEEN_MARKS {
            let bytes = std::mem::take(&mut self.unmarked);
            self.last_mark += 1;
            self.marks.push_back(Mark { number: self.last_mark, bytes, sent: now });
            self.repeat_at.get_or_insert(now + self.pause);
            return Some(Emission::Mark(self.last_mark));
        }
        if self.marks.iter().map(|mark| mark.bytes).sum::<usize>() + self.unmarked >= self.window {
            return None;
        }
        let id = self.turns.pop_front()?;
        let queue = self.queues.get_mut(&id)?;
        let (header, message, offset) = queue.front_mut()?;
        let (mut header, total) = (*header, message.len());
        let end = total.min(*offset + PIECE);
        let payload = message.slice(*offset..end);
        if total > PIECE {
            header.kind = Kind::Chunk { offset: *offset as u64, total: total as u64 };
        }
        *offset = end;
        if end == total {
            queue.pop_front();
        }
        match queue.is_empty() {
            true => drop(self.queues.remove(&id)),
            false => self.turns.push_back(id),
        }
        self.unmarked += payload.len() + OVERHEAD;
        Some(Emission::Piece { id, header, payload })
    }

    /// Handles the echo of a mark: everything up to it has arrived.
    pub(super) fn echo(&mut self, number: u64, now: Instant) {
        while let Some(mark) = self.marks.pop_front_if(|mark| mark.number <= number) {
            if mark.number == number {
                self.adapt(now.saturating_duration_since(mark.sent));
            }
        }
        self.pause = REPEAT_MARK;
        self.repeat_at = self.marks.front().map(|_| now + self.pause);
    }

    /// When [`repeat`](Self::repeat) has to be called.
    pub(super) fn deadline(&self) -> Option<Instant> {
        self.repeat_at
    }

    /// Returns the newest mark, which may be lost, to be sent again: at increasing intervals.
    pub(super) fn repeat(&mut self, now: Instant) -> Option<Emission> {
        self.repeat_at.filter(|at| *at <= now)?;
        self.pause = (self.pause * 2).min(8 * REPEAT_MARK);
        self.repeat_at = Some(now + self.pause);
        Some(Emission::Mark(self.marks.back()?.number))
    }

    fn adapt(&mut self, round_trip: Duration) {
        let best = self.round_trip.map_or(round_trip, |best| best.min(round_trip));
        self.round_trip = Some(best);
        self.window = match round_trip.saturating_sub(best) > LONGEST_WAIT {
            true => (self.window / 2).max(SMALLEST_WINDOW),
            false => (self.window + BETWEEN_MARKS).min(LARGEST_WINDOW),
        };
    }
}

#[cfg(test)]
mod tests;
