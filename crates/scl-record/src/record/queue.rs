//! The queue between the taps and the disk: it holds messages while the disk is slow, up to a limit in bytes.

use super::gate::Message;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Bytes after which the writer is woken. Below that, the writer polls the queue: waking it for each of several
/// thousand messages a second would cost more than writing them.
const WAKE: usize = 256 << 10;

/// An entry of the queue.
#[derive(Debug)]
pub(crate) enum Item<C> {
    Message(Message),
    /// A command for the writer, in order with the messages. Always accepted.
    Command(C),
}

/// The sending end, for the thread that reads the taps.
pub(crate) struct QueueSender<C>(Arc<Shared<C>>);

/// The receiving end, for the thread that writes.
pub(crate) struct QueueReceiver<C>(Arc<Shared<C>>);

struct Shared<C> {
    state: Mutex<State<C>>,
    changed: Condvar,
    limit: usize,
    /// Bytes pushed and not yet released, including those that the writer is working on.
    bytes: AtomicUsize,
}

struct State<C> {
    items: VecDeque<Item<C>>,
    closed: bool,
}

/// A queue that accepts messages up to `limit` bytes.
pub(crate) fn queue<C>(limit: usize) -> (QueueSender<C>, QueueReceiver<C>) {
    let state = Mutex::new(State { items: VecDeque::new(), closed: false });
    let shared = Arc::new(Shared { state, changed: Condvar::new(), limit, bytes: AtomicUsize::new(0) });
    (QueueSender(Arc::clone(&shared)), QueueReceiver(shared))
}

impl<C> QueueSender<C> {
    /// Adds a message; returns false if there is no room.
    pub(crate) fn push(&self, message: Message) -> bool {
        let size = message.memory();
        let before = self.0.bytes.load(Ordering::Relaxed);
        if before + size > self.0.limit {
            return false;
        }
        self.0.bytes.fetch_add(size, Ordering::Relaxed);
        self.0.lock().items.push_back(Item::Message(message));
        if before / WAKE != (before + size) / WAKE {
            self.0.changed.notify_one();
        }
        true
    }

    /// Adds a command and wakes the writer.
    pub(crate) fn command(&self, command: C) {
        self.0.lock().items.push_back(Item::Command(command));
        self.0.changed.notify_one();
    }
}

impl<C> Drop for QueueSender<C> {
    fn drop(&mut self) {
        self.0.lock().closed = true;
        self.0.changed.notify_one();
    }
}

impl<C> QueueReceiver<C> {
    /// Takes all items. If there are none, first waits up to `timeout` to be woken; the result may still be empty.
    /// `None` at the end.
    pub(crate) fn take(&self, timeout: Duration) -> Option<VecDeque<Item<C>>> {
        let mut state = self.0.lock();
        if state.items.is_empty() && !state.closed {
            state = self.0.changed.wait_timeout(state, timeout).unwrap_or_else(PoisonError::into_inner).0;
        }
        let items = std::mem::take(&mut state.items);
        (!items.is_empty() || !state.closed).then_some(items)
    }

    /// Makes room after a message has been dealt with.
    pub(crate) fn release(&self, bytes: usize) {
        self.0.bytes.fetch_sub(bytes, Ordering::Relaxed);
    }
}

impl<C> Shared<C> {
    fn lock(&self) -> MutexGuard<'_, State<C>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::Part;
    use bytes::Bytes;

    fn message(size: usize) -> Message {
        let payload = Bytes::from(vec![0; size]);
        Message {
            gate: 0,
            part: Part::Message,
            sequence: 0,
            sent_ns: 0,
            received_ns: 0,
            lost_before: 0,
            latched: false,
            payload,
        }
    }

    #[test]
    fn a_full_queue_has_room_again_after_a_release() {
        let (sender, receiver) = queue::<()>(2 * message(100).memory());
        assert!(sender.push(message(100)) && sender.push(message(100)));
        assert!(!sender.push(message(100)));
        let taken = receiver.take(Duration::ZERO).unwrap();
        assert_eq!(taken.len(), 2);
        assert!(!sender.push(message(100)), "the writer still holds both");
        receiver.release(message(100).memory());
        assert!(sender.push(message(100)));
    }

    #[test]
    fn what_was_sent_before_the_end_is_received() {
        let (sender, receiver) = queue::<u8>(0);
        sender.command(7);
        drop(sender);
        assert!(matches!(receiver.take(Duration::MAX).unwrap().pop_front(), Some(Item::Command(7))));
        assert!(receiver.take(Duration::MAX).is_none());
    }
}
