//! The senders of a listening end, and how many of their messages wait in its gate.

use super::round_robin::RoundRobin;
use std::collections::VecDeque;
use std::task::Poll;

/// The connected senders. Each is identified by a number, because it may disconnect while its messages still wait.
pub(super) struct Senders<E> {
    connected: RoundRobin<Connected<E>>,
    /// Number of senders so far.
    accepted: u64,
    origins: Origins,
}

struct Connected<E> {
    number: u64,
    /// Number of its messages that wait in the gate.
    waiting: u64,
    end: E,
}

impl<E> Senders<E> {
    /// `in_a_row`: as for [`RoundRobin::new`].
    pub(super) fn new(in_a_row: usize) -> Self {
        Self { connected: RoundRobin::new(in_a_row), accepted: 0, origins: Origins::default() }
    }

    pub(super) fn add(&mut self, end: E) {
        self.connected.connections.push(Connected { number: self.accepted, waiting: 0, end });
        self.accepted += 1;
    }

    /// Like [`RoundRobin::poll`]. A message that is returned counts as waiting.
    pub(super) fn poll<M>(&mut self, mut poll: impl FnMut(&mut E) -> Poll<Option<M>>) -> Poll<M> {
        self.connected.poll(|sender| {
            let polled = poll(&mut sender.end);
            if let Poll::Ready(Some(_)) = polled {
                self.origins.push(sender.number);
                sender.waiting += 1;
            }
            polled
        })
    }

    pub(super) fn ends(&self) -> impl Iterator<Item = &E> {
        self.connected.connections.iter().map(|sender| &sender.end)
    }

    /// Iterates over the senders, with the number of messages of each that wait.
    pub(super) fn ends_mut(&mut self) -> impl Iterator<Item = (&mut E, u64)> {
        self.connected.connections.iter_mut().map(|sender| (&mut sender.end, sender.waiting))
    }

    /// Notes that only the newest `waiting` messages still wait. Calls `gone` with the sender and the number of the
    /// others, if the sender is still connected: one that has left counts its messages as lost.
    pub(super) fn keep_newest(&mut self, waiting: u64, mut gone: impl FnMut(&mut E, u64)) {
        let connected = &mut self.connected.connections;
        self.origins.keep_newest(waiting, |number, count| {
            if let Some(sender) = connected.iter_mut().find(|sender| sender.number == number) {
                sender.waiting -= count;
                gone(&mut sender.end, count);
            }
        });
    }

    /// Notes that the message returned last does not wait.
    pub(super) fn drop_newest(&mut self) {
        let newest = self.origins.drop_newest();
        if let Some(sender) = self.connected.connections.iter_mut().find(|sender| Some(sender.number) == newest) {
            sender.waiting -= 1;
        }
    }
}

#[cfg(feature = "zeromq")]
impl<E> Senders<E> {
    pub(super) fn is_turn_over(&self) -> bool {
        self.connected.is_turn_over()
    }

    pub(super) fn len(&self) -> usize {
        self.connected.connections.len()
    }

    /// Number of messages that wait, also of senders that have left.
    pub(super) fn waiting(&self) -> u64 {
        self.origins.total
    }
}

/// The senders, by number, of the messages that a listening end has returned and that still wait in its gate.
/// Run-length encoded, the oldest first: a sender, and how many of its messages follow each other.
#[derive(Default)]
struct Origins {
    runs: VecDeque<(u64, u64)>,
    total: u64,
}

impl Origins {
    /// Adds a message of this sender, which was just returned.
    fn push(&mut self, sender: u64) {
        match self.runs.back_mut() {
            Some((last, count)) if *last == sender => *count += 1,
            _ => self.runs.push_back((sender, 1)),
        }
        self.total += 1;
    }

    /// Removes the message returned last, which does not wait. Returns its sender.
    fn drop_newest(&mut self) -> Option<u64> {
        let (sender, count) = self.runs.back_mut()?;
        (*count, self.total) = (*count - 1, self.total - 1);
        let sender = *sender;
        self.runs.pop_back_if(|(_, count)| *count == 0);
        Some(sender)
    }

    /// Removes all but the newest `waiting` messages. Calls `gone` with the sender and the number of those removed.
    fn keep_newest(&mut self, waiting: u64, mut gone: impl FnMut(u64, u64)) {
        while self.total > waiting
            && let Some((sender, count)) = self.runs.front_mut()
        {
            let oldest = (*count).min(self.total - waiting);
            (*count, self.total) = (*count - oldest, self.total - oldest);
            gone(*sender, oldest);
            self.runs.pop_front_if(|(_, count)| *count == 0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_go_first_and_a_dropped_message_is_the_newest() {
        let mut origins = Origins::default();
        [1, 1, 2, 1, 3].into_iter().for_each(|sender| origins.push(sender));
        assert_eq!(origins.drop_newest(), Some(3));
        let mut gone = Vec::new();
        origins.keep_newest(1, |sender, count| gone.push((sender, count)));
        assert_eq!(gone, [(1, 2), (2, 1)]);
        origins.keep_newest(1, |_, _| panic!("one waits"));
        assert_eq!((origins.drop_newest(), origins.drop_newest()), (Some(1), None));
    }
}
