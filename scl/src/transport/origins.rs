//! Whose messages wait in a gate that listens for several senders.

use std::collections::VecDeque;

/// The senders, by number, of the messages that a listening end has returned and that still wait in its gate. The
/// oldest are first, with how many of one sender follow each other.
#[derive(Default)]
pub(super) struct Origins {
    runs: VecDeque<(u64, u64)>,
    total: u64,
}

impl Origins {
    /// A message of this sender was returned.
    pub(super) fn push(&mut self, sender: u64) {
        match self.runs.back_mut() {
            Some((last, count)) if *last == sender => *count += 1,
            _ => self.runs.push_back((sender, 1)),
        }
        self.total += 1;
    }

    /// The message returned last does not wait. Returns its sender.
    pub(super) fn drop_newest(&mut self) -> Option<u64> {
        let (sender, count) = self.runs.back_mut()?;
        (*count, self.total) = (*count - 1, self.total - 1);
        let sender = *sender;
        self.runs.pop_back_if(|(_, count)| *count == 0);
        Some(sender)
    }

    /// Only this number of messages wait, the newest. Calls `gone` with the senders of the others and how many they
    /// were.
    pub(super) fn keep_newest(&mut self, waiting: u64, mut gone: impl FnMut(u64, u64)) {
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
