//! The bounded queue of a connection or gate, with the policy that the topology declares. Sending and receiving ends
//! both use this type.

use crate::spec::WhenFull;
use std::collections::VecDeque;
use std::time::Instant;

/// How many messages may wait, and what happens to one more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct QueuePolicy {
    pub(crate) capacity: usize,
    /// With `Wait`, the sender checks [`Queue::is_full`] before it pushes; a message pushed into a full queue anyway
    /// replaces the oldest.
    pub(crate) when_full: WhenFull,
}

/// Messages that wait, oldest first.
pub(crate) struct Queue<T> {
    items: VecDeque<T>,
    /// When each of them was put here, if somebody wants to know.
    times: Option<VecDeque<Instant>>,
    pub(crate) policy: QueuePolicy,
    /// Messages replaced by a newer one in a queue where only the newest counts; not counted as dropped.
    pub(crate) replaced: u64,
    pub(crate) dropped_oldest: u64,
    pub(crate) dropped_newest: u64,
}

/// What happened to a message that was pushed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pushed {
    Stored,
    /// It was stored, and the oldest was dropped.
    ReplacedOldest,
    /// It was dropped.
    Dropped,
}

impl QueuePolicy {
    /// Returns true if only the newest message counts: a queue of one, in which each message replaces the one before.
    pub(crate) fn newest_only(self) -> bool {
        self.capacity == 1 && self.when_full == WhenFull::DropOldest
    }
}

impl<T> Queue<T> {
    pub(crate) fn new(policy: QueuePolicy) -> Self {
        Self { items: VecDeque::new(), times: None, policy, replaced: 0, dropped_oldest: 0, dropped_newest: 0 }
    }

    /// A queue that keeps the times of its messages.
    pub(crate) fn timed(self) -> Self {
        Self { times: Some(VecDeque::new()), ..self }
    }

    pub(crate) fn push(&mut self, item: T) -> Pushed {
        let pushed = self.replace(item);
        match pushed {
            Pushed::Stored => {}
            Pushed::ReplacedOldest if self.policy.newest_only() => self.replaced += 1,
            Pushed::ReplacedOldest => self.dropped_oldest += 1,
            Pushed::Dropped => self.dropped_newest += 1,
        }
        pushed
    }

    /// Like [`push`](Self::push), but counts nothing as replaced or dropped: a foreign program in the peer's place has
    /// already received the messages.
    pub(crate) fn replace(&mut self, item: T) -> Pushed {
        if !self.is_full() {
            self.push_back(item);
            return Pushed::Stored;
        }
        if self.policy.when_full == WhenFull::DropNewest {
            return Pushed::Dropped;
        }
        self.pop();
        self.push_back(item);
        Pushed::ReplacedOldest
    }

    /// Stores a message that must not be dropped. If the queue is full, drops its newest message instead and returns
    /// it.
    pub(crate) fn push_over_newest(&mut self, item: T) -> Option<T> {
        let newest = if self.is_full() { self.pop_back() } else { None };
        self.dropped_newest += u64::from(newest.is_some());
        self.push_back(item);
        newest
    }

    pub(crate) fn pop(&mut self) -> Option<T> {
        if let Some(times) = &mut self.times {
            times.pop_front();
        }
        self.items.pop_front()
    }

    /// Adds a message, whether there is room or not.
    pub(crate) fn push_back(&mut self, item: T) {
        if let Some(times) = &mut self.times {
            times.push_back(Instant::now());
        }
        self.items.push_back(item);
    }

    /// Takes the newest message.
    pub(crate) fn pop_back(&mut self) -> Option<T> {
        if let Some(times) = &mut self.times {
            times.pop_back();
        }
        self.items.pop_back()
    }

    /// Returns the waiting messages, for a link that takes several at once, and their times, if this queue keeps them.
    pub(crate) fn parts_mut(&mut self) -> (&mut VecDeque<T>, Option<&mut VecDeque<Instant>>) {
        (&mut self.items, self.times.as_mut())
    }

    pub(crate) fn front(&self) -> Option<&T> {
        self.items.front()
    }

    /// Returns the waiting messages of a queue without times.
    pub(crate) fn items_mut(&mut self) -> &mut VecDeque<T> {
        debug_assert!(self.times.is_none(), "each message has its time");
        &mut self.items
    }

    pub(crate) fn len(&self) -> usize {
        self.items.len()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    pub(crate) fn is_full(&self) -> bool {
        self.items.len() >= self.policy.capacity
    }

    /// Returns true if a full queue makes the sender wait.
    pub(crate) fn waits(&self) -> bool {
        self.policy.when_full == WhenFull::Wait
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_queue_does_what_was_declared() {
        let cases = [
            (WhenFull::DropOldest, Pushed::ReplacedOldest, [2, 3], (1, 0)),
            (WhenFull::DropNewest, Pushed::Dropped, [1, 2], (0, 1)),
            (WhenFull::Wait, Pushed::ReplacedOldest, [2, 3], (1, 0)),
        ];
        for (when_full, expected, left, dropped) in cases {
            let mut queue = Queue::new(QueuePolicy { capacity: 2, when_full });
            assert_eq!([queue.push(1), queue.push(2)], [Pushed::Stored; 2], "{when_full:?}");
            assert_eq!(queue.push(3), expected, "{when_full:?}");
            assert_eq!(*queue.items_mut(), left, "{when_full:?}");
            assert_eq!((queue.dropped_oldest, queue.dropped_newest), dropped, "{when_full:?}");
        }
    }

    #[test]
    fn a_queue_for_the_newest_value_replaces_and_drops_nothing() {
        let mut queue = Queue::new(QueuePolicy { capacity: 1, when_full: WhenFull::DropOldest });
        assert_eq!([queue.push(1), queue.push(2)], [Pushed::Stored, Pushed::ReplacedOldest]);
        assert_eq!((queue.replaced, queue.dropped_oldest), (1, 0));
        // A sender that may not wait for an absent peer drops what it was to keep.
        let mut queue = Queue::new(QueuePolicy { capacity: 1, when_full: WhenFull::Wait });
        assert_eq!([queue.push(1), queue.push(2)], [Pushed::Stored, Pushed::ReplacedOldest]);
        assert_eq!((queue.replaced, queue.dropped_oldest), (0, 1));
    }

    #[test]
    fn what_somebody_else_has_taken_is_not_counted_as_dropped() {
        for capacity in [1, 2] {
            let mut queue = Queue::new(QueuePolicy { capacity, when_full: WhenFull::DropOldest });
            (0..capacity).for_each(|item| assert_eq!(queue.replace(item), Pushed::Stored));
            assert_eq!(queue.replace(7), Pushed::ReplacedOldest);
            assert_eq!(queue.items_mut().back(), Some(&7));
            assert_eq!((queue.dropped_oldest, queue.replaced), (0, 0));
        }
    }
}
