//! Messages that wait for the beat at which they take effect.
//!
//! A message takes effect at a fixed time rather than when it arrives. As long as it arrives before that time, the
//! outcome does not depend on the operating system's scheduling, and a recorded flight can be repeated exactly.

/// Maximum number of messages. More would mean that the beat has stopped; the oldest are then useless and are dropped.
const CAPACITY: usize = 8;

/// Messages of one gate, ordered by the time at which they are due.
#[derive(Clone, Debug)]
pub struct Pending<T> {
    messages: Vec<(u64, T)>,
}

impl<T> Default for Pending<T> {
    fn default() -> Self {
        Self { messages: Vec::with_capacity(CAPACITY) }
    }
}

impl<T> Pending<T> {
    /// Keeps a message until `due_us`. Of messages that are due at the same time, the first to arrive comes first.
    pub fn insert(&mut self, due_us: u64, message: T) {
        if self.messages.len() == CAPACITY {
            self.messages.remove(0);
        }
        let index = self.messages.iter().take_while(|(due, _)| *due <= due_us).count();
        self.messages.insert(index, (due_us, message));
    }

    /// Removes and returns the next message that is due at `now_us`.
    pub fn take_due(&mut self, now_us: u64) -> Option<T> {
        let (due, _) = self.messages.first()?;
        if *due <= now_us { Some(self.messages.remove(0).1) } else { None }
    }

    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.messages.iter().map(|(_, message)| message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_taken_in_the_order_in_which_they_are_due() {
        let mut pending = Pending::default();
        for (due, message) in [(30, 'c'), (10, 'a'), (30, 'd'), (20, 'b')] {
            pending.insert(due, message);
        }
        assert_eq!(pending.take_due(9), None);
        assert_eq!(pending.take_due(20), Some('a'));
        assert_eq!(pending.take_due(20), Some('b'));
        assert_eq!(pending.take_due(20), None);
        assert_eq!(pending.take_due(99), Some('c'));
        assert_eq!(pending.take_due(99), Some('d'));
    }

    #[test]
    fn the_oldest_gives_way_when_nothing_is_taken() {
        let mut pending = Pending::default();
        (0..10).for_each(|due| pending.insert(due, due));
        assert_eq!(pending.take_due(99), Some(2));
    }
}
