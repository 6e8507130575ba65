//! A bounded queue between two ends, each of which notices when the other is gone.

use crate::sync::lock;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};

/// A queue of at most `capacity` items.
pub(super) fn pipe<T>(capacity: usize) -> (Sender<T>, Receiver<T>) {
    let state = State { queue: VecDeque::new(), closed: false, refused: false, writer: None, reader: None };
    let shared = Arc::new(Shared { state: Mutex::new(state), capacity });
    (Sender { shared: Arc::clone(&shared) }, Receiver { shared })
}

pub(super) struct Sender<T> {
    shared: Arc<Shared<T>>,
}

pub(super) struct Receiver<T> {
    shared: Arc<Shared<T>>,
}

struct Shared<T> {
    state: Mutex<State<T>>,
    capacity: usize,
}

struct State<T> {
    queue: VecDeque<T>,
    /// Set when either end is gone.
    closed: bool,
    /// Set when the sender found no room, until it is woken for it.
    refused: bool,
    writer: Option<Waker>,
    reader: Option<Waker>,
}

impl<T> Sender<T> {
    /// Appends an item, unless there is no room or nobody to read it.
    pub(super) fn send(&self, item: T) -> Result<(), T> {
        let mut state = lock(&self.shared.state);
        if state.closed || state.queue.len() >= self.shared.capacity {
            return Err(item);
        }
        state.queue.push_back(item);
        let reader = state.reader.take();
        drop(state);
        wake(reader);
        Ok(())
    }

    /// Whether an item would be taken; if there is no room, the task is woken when there is some again.
    pub(super) fn has_room(&self, cx: &Context<'_>) -> bool {
        let mut state = lock(&self.shared.state);
        if state.queue.len() < self.shared.capacity {
            return true;
        }
        state.refused = true;
        keep(&mut state.writer, cx);
        false
    }

    /// Whether the reader is there; the task is woken when it goes.
    pub(super) fn is_read(&self, cx: &Context<'_>) -> bool {
        let mut state = lock(&self.shared.state);
        keep(&mut state.writer, cx);
        !state.closed
    }

    pub(super) fn is_open(&self) -> bool {
        !lock(&self.shared.state).closed
    }

    /// Lets the reader have what is in the queue, and then know that nothing follows.
    pub(super) fn close(&self) {
        let mut state = lock(&self.shared.state);
        state.closed = true;
        let reader = state.reader.take();
        drop(state);
        wake(reader);
    }
}

impl<T> Receiver<T> {
    /// The next item, or `None` when the sender is gone and its last item was taken.
    pub(super) fn poll_recv(&self, cx: &Context<'_>) -> Poll<Option<T>> {
        let mut state = lock(&self.shared.state);
        let Some(item) = state.queue.pop_front() else {
            if state.closed {
                return Poll::Ready(None);
            }
            keep(&mut state.reader, cx);
            return Poll::Pending;
        };
        // A sender that found no room is woken when half of it is free, so that it can hand over several at once.
        let room = state.refused && state.queue.len() <= self.shared.capacity / 2;
        state.refused &= !room;
        let writer = if room { state.writer.take() } else { None };
        drop(state);
        wake(writer);
        Poll::Ready(Some(item))
    }

    pub(super) fn is_open(&self) -> bool {
        !lock(&self.shared.state).closed
    }
}

impl<T> Drop for Sender<T> {
    fn drop(&mut self) {
        self.close();
    }
}

impl<T> Drop for Receiver<T> {
    fn drop(&mut self) {
        let mut state = lock(&self.shared.state);
        state.closed = true;
        let writer = state.writer.take();
        // Nobody will read what is left.
        let unread = std::mem::take(&mut state.queue);
        drop(state);
        drop(unread);
        wake(writer);
    }
}

/// Keeps the task's waker for later, without cloning one that is there already.
pub(super) fn keep(slot: &mut Option<Waker>, cx: &Context<'_>) {
    if !slot.as_ref().is_some_and(|kept| kept.will_wake(cx.waker())) {
        *slot = Some(cx.waker().clone());
    }
}

pub(super) fn wake(waker: Option<Waker>) {
    if let Some(waker) = waker {
        waker.wake();
    }
}
