//! Ends with a waker of their own, which are called only when it was woken.

use super::{AnyInlet, AnyOutlet};
use crate::sync::lock;
use crate::transport::{Answer, Answerer, Asked, Asker};
use bytes::Bytes;
use std::collections::VecDeque;
use std::future::poll_fn;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Wake, Waker};

/// An end and its own waker.
pub(super) struct Watched<E> {
    end: E,
    signal: Arc<Signal>,
    waker: Waker,
}

#[derive(Default)]
struct Signal {
    woken: AtomicBool,
    wakes: AtomicUsize,
    test: Mutex<Option<Waker>>,
}

impl Wake for Signal {
    fn wake(self: Arc<Self>) {
        self.wakes.fetch_add(1, Ordering::SeqCst);
        self.woken.store(true, Ordering::SeqCst);
        let test = lock(&self.test).clone();
        if let Some(test) = test {
            test.wake();
        }
    }
}

impl<E> Watched<E> {
    fn of(end: E) -> Self {
        let signal = Arc::new(Signal { woken: AtomicBool::new(true), ..Signal::default() });
        Self { end, waker: Arc::clone(&signal).into(), signal }
    }

    /// How often this end has woken its task.
    pub(super) fn wakes(&self) -> usize {
        self.signal.wakes.load(Ordering::SeqCst)
    }

    /// Whether it is this end's turn: at first, after it was woken, and after it had something.
    fn is_woken(&self, test: &Context<'_>) -> bool {
        *lock(&self.signal.test) = Some(test.waker().clone());
        self.signal.woken.swap(false, Ordering::SeqCst)
    }

    fn poll<R>(&mut self, test: &Context<'_>, poll: impl FnOnce(&mut E, &mut Context<'_>) -> Poll<R>) -> Poll<R> {
        if !self.is_woken(test) {
            return Poll::Pending;
        }
        let polled = poll(&mut self.end, &mut Context::from_waker(&self.waker));
        if polled.is_ready() {
            self.signal.woken.store(true, Ordering::SeqCst);
        }
        polled
    }
}

/// A sending end, with what it is to send.
pub(super) struct Sending {
    watched: Watched<AnyOutlet>,
    present: bool,
    refused: bool,
    queue: VecDeque<Bytes>,
}

impl Sending {
    pub(super) fn new(end: AnyOutlet) -> Self {
        Self { watched: Watched::of(end), present: false, refused: false, queue: VecDeque::new() }
    }

    pub(super) fn wakes(&self) -> usize {
        self.watched.wakes()
    }

    pub(super) fn queue(&mut self, messages: impl IntoIterator<Item = Bytes>) {
        self.queue.extend(messages);
    }

    pub(super) fn left(&self) -> usize {
        self.queue.len()
    }

    pub(super) fn is_flushed(&self) -> bool {
        self.queue.is_empty() && self.watched.end.is_flushed()
    }

    /// Drives the end if it was woken, and offers what is queued; a message that was given back only after a wake-up.
    /// Whether a peer is there.
    pub(super) fn poll(&mut self, test: &Context<'_>) -> bool {
        let mut cx = Context::from_waker(&self.watched.waker);
        if self.watched.is_woken(test) {
            self.present = self.watched.end.drive(&mut cx);
            self.refused = false;
        }
        if self.present
            && !self.refused
            && let Some(message) = self.queue.pop_front()
        {
            let sent = message.clone();
            if let Err(returned) = self.watched.end.offer(&mut cx, message) {
                assert_eq!(returned, sent, "an offer gave back another message");
                self.queue.push_front(returned);
                self.refused = true;
            }
        }
        // The first message alone, the others together: both ways are there to be used by turns.
        if self.present && !self.refused {
            self.offer_all();
        }
        self.present
    }

    fn offer_all(&mut self) {
        let cx = &mut Context::from_waker(&self.watched.waker);
        let (offered, mut lengths) = (self.queue.clone(), Vec::new());
        self.watched.end.offer_all(cx, &mut self.queue, &mut |length| lengths.push(length));
        let taken = offered.len() - self.queue.len();
        assert!(offered.range(taken..).eq(&self.queue), "an offer of several changed those that it gave back");
        let expected = offered.range(..taken).map(Bytes::len);
        assert!(expected.eq(lengths), "an offer of several told other lengths than those of what it took");
        self.refused = !self.queue.is_empty();
    }

    /// Offers a message, whether or not anybody is there; what is given back.
    pub(super) fn offer(&mut self, message: Bytes) -> Result<(), Bytes> {
        self.watched.end.offer(&mut Context::from_waker(&self.watched.waker), message)
    }

    /// Waits until a peer is there, or no longer.
    pub(super) async fn until_present(&mut self, present: bool) {
        poll_fn(|cx| if self.poll(cx) == present { Poll::Ready(()) } else { Poll::Pending }).await;
    }
}

/// A receiving end.
pub(super) struct Receiving(Watched<AnyInlet>);

impl Receiving {
    pub(super) fn new(end: AnyInlet) -> Self {
        Self(Watched::of(end))
    }

    pub(super) fn wakes(&self) -> usize {
        self.0.wakes()
    }
    pub(super) fn poll(&mut self, test: &Context<'_>) -> Poll<Bytes> {
        self.0.poll(test, |end, cx| end.poll_recv(cx))
    }

    /// The next message, while senders are kept going.
    pub(super) async fn next(&mut self, senders: &mut [&mut Sending]) -> Bytes {
        poll_fn(|cx| {
            for sender in &mut *senders {
                sender.poll(cx);
            }
            self.poll(cx)
        })
        .await
    }
}

/// An asking end.
pub(super) struct Asking(Watched<Box<dyn Asker>>);

impl Asking {
    pub(super) fn new(end: Box<dyn Asker>) -> Self {
        Self(Watched::of(end))
    }

    pub(super) fn wakes(&self) -> usize {
        self.0.wakes()
    }

    pub(super) fn is_connected(&self) -> bool {
        self.0.end.is_connected()
    }

    pub(super) fn ask(&mut self, id: u64, body: Bytes) -> Result<(), Bytes> {
        self.0.end.ask(id, body)
    }

    pub(super) fn poll_connected(&mut self, test: &Context<'_>) -> Poll<()> {
        self.0.poll(test, |end, cx| end.poll_connected(cx))
    }

    pub(super) fn poll_answer(&mut self, test: &Context<'_>) -> Poll<Answer> {
        self.0.poll(test, |end, cx| end.poll_answer(cx))
    }
}

/// An answering end.
pub(super) struct Answering(Watched<Box<dyn Answerer>>);

impl Answering {
    pub(super) fn new(end: Box<dyn Answerer>) -> Self {
        Self(Watched::of(end))
    }

    pub(super) fn wakes(&self) -> usize {
        self.0.wakes()
    }

    pub(super) fn poll(&mut self, test: &Context<'_>) -> Poll<Asked> {
        self.0.poll(test, |end, cx| end.poll_asked(cx))
    }
}
