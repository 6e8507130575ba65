//! A bounded queue between two ends, each of which notices when the other is dropped.

use crate::sync::{keep_waker, lock};
use crate::transport::Endpoint;
use std::cell::Cell;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};
use std::time::Instant;

/// Creates a queue of at most `capacity` items.
pub(super) fn pipe<T>(capacity: usize) -> (PipeWriter<T>, PipeReader<T>) {
    pipe_of(capacity, &Endpoint::new(""))
}

/// Like `pipe`, with a reader that knows whether its writer's endpoint is lossless and whether it is latched.
pub(super) fn pipe_of<T>(capacity: usize, writer: &Endpoint) -> (PipeWriter<T>, PipeReader<T>) {
    let state = State {
        queue: VecDeque::new(),
        sent: 0,
        times: VecDeque::new(),
        untaken: 0,
        closed: false,
        wants_room: false,
        wants_empty: false,
        holds_back: false,
        question: Question::None,
        writer: None,
        reader: None,
    };
    let (state, received) = (Mutex::new(state), AtomicU64::new(0));
    let shared = Arc::new(Shared { state, received, capacity, lossless: writer.lossless, latched: writer.latched });
    (PipeWriter { shared: Arc::clone(&shared) }, PipeReader { shared, taken: Cell::new(0), last: Cell::new(None) })
}

pub(super) struct PipeWriter<T> {
    shared: Arc<Shared<T>>,
}

pub(super) struct PipeReader<T> {
    shared: Arc<Shared<T>>,
    /// Number of items taken so far.
    taken: Cell<u64>,
    /// The last taken item whose time the writer has told.
    last: Cell<Option<Timed>>,
}

struct Shared<T> {
    state: Mutex<State<T>>,
    /// Number of items that the reader has taken and its caller does not keep for later.
    received: AtomicU64,
    capacity: usize,
    lossless: bool,
    latched: bool,
}

struct State<T> {
    queue: VecDeque<T>,
    /// Number of items sent so far.
    sent: u64,
    /// The items whose time the writer has told.
    times: VecDeque<Timed>,
    /// Number of items that the reader has not taken. Those it left behind when it was dropped still count.
    untaken: u64,
    /// Set when either end is dropped.
    closed: bool,
    /// The writer was refused and has not been woken since.
    wants_room: bool,
    /// The writer asked to be woken when everything is taken.
    wants_empty: bool,
    /// The writer was refused and has not said since that nothing more is waiting.
    holds_back: bool,
    question: Question,
    writer: Option<Waker>,
    reader: Option<Waker>,
}

/// An item whose time is known.
#[derive(Clone, Copy)]
struct Timed {
    /// Its number, from 1.
    number: u64,
    /// When it was sent.
    sent: Instant,
    /// Whether that was before the reader joined.
    is_latched: bool,
}

/// Whether the reader has asked for what the writer holds back.
#[derive(PartialEq)]
enum Question {
    None,
    Asked,
    /// After the reader asked, the writer had nothing left to send.
    Answered,
}

impl<T> State<T> {
    fn push(&mut self, item: T) {
        self.queue.push_back(item);
        self.sent += 1;
        self.untaken += 1;
    }

    fn refuse(&mut self, cx: &Context<'_>) {
        self.wants_room = true;
        self.holds_back = true;
        keep_waker(&mut self.writer, cx.waker());
    }
}

impl<T> PipeWriter<T> {
    /// Appends an item, or returns it if there is no room or no reader. Wakes the task when it should try again, or
    /// find out that the reader is gone. `sent` is when the item was sent, if the reader is to learn that, and whether
    /// that was before it joined.
    pub(super) fn send(&self, cx: &Context<'_>, item: T, sent: Option<(Instant, bool)>) -> Result<(), T> {
        let mut state = lock(&self.shared.state);
        if state.closed {
            drop(state);
            cx.waker().wake_by_ref();
            return Err(item);
        }
        if state.queue.len() >= self.shared.capacity {
            state.refuse(cx);
            return Err(item);
        }
        state.push(item);
        if let Some((sent, is_latched)) = sent {
            let number = state.sent;
            state.times.push_back(Timed { number, sent, is_latched });
        }
        let reader = state.reader.take();
        drop(state);
        wake(reader);
        Ok(())
    }

    /// Takes items from the front of a queue while there is room, converts them with `to_item`, calls `sent` with each,
    /// and appends them. If that empties the queue, the reader learns that nothing is held back.
    pub(super) fn send_all<S>(
        &self,
        cx: &Context<'_>,
        items: &mut VecDeque<S>,
        to_item: impl Fn(S) -> T,
        mut sent: impl FnMut(&T),
    ) {
        let mut state = lock(&self.shared.state);
        if state.closed {
            drop(state);
            return cx.waker().wake_by_ref();
        }
        let count = items.len().min(self.shared.capacity.saturating_sub(state.queue.len()));
        for item in items.drain(..count).map(to_item) {
            sent(&item);
            state.push(item);
        }
        let mut is_news = count > 0;
        if items.is_empty() {
            state.holds_back = false;
            if state.question == Question::Asked {
                state.question = Question::Answered;
                is_news = true;
            }
        } else {
            state.refuse(cx);
        }
        let reader = if is_news { state.reader.take() } else { None };
        drop(state);
        wake(reader);
    }

    /// Returns true if an item can be sent now. If not, the task is woken when there is room.
    pub(super) fn has_room(&self, cx: &Context<'_>) -> bool {
        let mut state = lock(&self.shared.state);
        if state.queue.len() < self.shared.capacity {
            return true;
        }
        state.refuse(cx);
        false
    }

    /// Returns true if the reader still exists. Wakes the task when the reader is dropped.
    pub(super) fn poll_open(&self, cx: &Context<'_>) -> bool {
        let mut state = lock(&self.shared.state);
        keep_waker(&mut state.writer, cx.waker());
        !state.closed
    }

    pub(super) fn is_open(&self) -> bool {
        !lock(&self.shared.state).closed
    }

    /// Number of items sent that the reader has not taken, including those it left behind when it was dropped.
    pub(super) fn untaken(&self) -> u64 {
        lock(&self.shared.state).untaken
    }

    /// Number of items sent that are untaken, or that the caller of the reader keeps for later.
    pub(super) fn not_received(&self) -> u64 {
        lock(&self.shared.state).sent - self.shared.received.load(Ordering::Acquire)
    }

    /// Wakes the task when the reader has taken everything.
    pub(super) fn wake_when_empty(&self, cx: &Context<'_>) {
        let mut state = lock(&self.shared.state);
        if state.untaken > 0 {
            state.wants_empty = true;
            keep_waker(&mut state.writer, cx.waker());
        }
    }

    /// Ends the pipe: the reader can still take what is in the queue.
    pub(super) fn close(&self) {
        let mut state = lock(&self.shared.state);
        state.closed = true;
        let reader = state.reader.take();
        drop(state);
        wake(reader);
    }
}

impl<T> PipeReader<T> {
    /// Returns the next item, or `None` if the writer is gone and everything has been taken.
    pub(super) fn poll_recv(&self, cx: &Context<'_>) -> Poll<Option<T>> {
        let mut state = lock(&self.shared.state);
        let Some(item) = state.queue.pop_front() else {
            if state.closed {
                return Poll::Ready(None);
            }
            keep_waker(&mut state.reader, cx.waker());
            return Poll::Pending;
        };
        state.untaken -= 1;
        self.taken.set(self.taken.get() + 1);
        let taken = self.taken.get();
        if let Some(timed) = state.times.pop_front_if(|timed| timed.number == taken) {
            self.last.set(Some(timed));
        }
        // A refused writer is woken when half of the queue is free, so that it can send several items at once.
        let has_room = state.wants_room && state.queue.len() <= self.shared.capacity / 2;
        let is_empty = state.wants_empty && state.queue.is_empty();
        state.wants_room &= !has_room;
        state.wants_empty &= !is_empty;
        let writer = if has_room || is_empty { state.writer.take() } else { None };
        drop(state);
        wake(writer);
        Poll::Ready(Some(item))
    }

    /// Returns true if the writer holds nothing back, or held nothing back after it was asked. If not, asks it, and
    /// wakes the task when it has answered. Call it when there is nothing to receive.
    pub(super) fn poll_caught_up(&self, cx: &Context<'_>) -> bool {
        let mut state = lock(&self.shared.state);
        if state.closed || !state.holds_back || state.question == Question::Answered {
            return true;
        }
        // The writer needs no waking: it was woken when the queue became empty, because it had been refused.
        state.question = Question::Asked;
        keep_waker(&mut state.reader, cx.waker());
        false
    }

    /// Notes how many of the items that were returned the caller keeps for later.
    pub(super) fn note_waiting(&self, waiting: u64) {
        // `waiting` may include items of an earlier pipe.
        let received = self.taken.get().saturating_sub(waiting);
        self.shared.received.fetch_max(received, Ordering::Release);
    }

    /// Returns true if the writer waits instead of dropping items.
    pub(super) fn is_lossless(&self) -> bool {
        self.shared.lossless
    }

    /// Returns true if the writer keeps its last item for readers that join.
    pub(super) fn is_latched(&self) -> bool {
        self.shared.latched
    }

    /// Returns when an item was sent, if that was before this reader joined. The item is `before_last` items before the
    /// one taken last.
    pub(super) fn latched(&self, before_last: u64) -> Option<Instant> {
        let timed = self.last.get().filter(|timed| timed.is_latched)?;
        (timed.number + before_last == self.taken.get()).then_some(timed.sent)
    }

    /// Returns when an item was sent, if the writer has told. The item is `before_last` items before the one taken
    /// last.
    pub(super) fn sent(&self, before_last: u64) -> Option<Instant> {
        let timed = self.last.get()?;
        (timed.number + before_last == self.taken.get()).then_some(timed.sent)
    }

    /// Makes the next [`poll_caught_up`](Self::poll_caught_up) ask again.
    pub(super) fn forget_answer(&self) {
        lock(&self.shared.state).question = Question::None;
    }

    pub(super) fn is_open(&self) -> bool {
        !lock(&self.shared.state).closed
    }
}

impl<T> Drop for PipeWriter<T> {
    fn drop(&mut self) {
        self.close();
    }
}

impl<T> Drop for PipeReader<T> {
    fn drop(&mut self) {
        let mut state = lock(&self.shared.state);
        state.closed = true;
        let writer = state.writer.take();
        let discarded = std::mem::take(&mut state.queue);
        drop(state);
        drop(discarded);
        wake(writer);
    }
}

/// Wakes a task. Call it without holding a lock, because a waker may run arbitrary code.
pub(super) fn wake(waker: Option<Waker>) {
    if let Some(waker) = waker {
        waker.wake();
    }
}
