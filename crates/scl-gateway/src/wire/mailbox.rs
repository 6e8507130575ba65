//! Queues between threads, and what the callbacks of the network library put into them for the ends of a stream.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard};
use std::task::{Context, Poll, Waker};

use bytes::Bytes;

use super::header::{Ack, Header};

/// What callbacks report to a sending end.
#[derive(Debug)]
pub(super) enum SendingMail {
    /// The receiving end that is open now.
    Peer(Option<u64>),
    Ack(Ack),
}

/// What callbacks report to a receiving end.
#[derive(Debug)]
pub(super) enum ReceivingMail {
    /// The sending end that is open now.
    Peer(Option<u64>),
    Arrived(Header, Bytes),
}

/// A queue that wakes its reader. Its size is bounded by weight; an item that does not fit is dropped, as a network may
/// do.
#[derive(Debug)]
pub(super) struct Mailbox<T> {
    inner: Mutex<Inner<T>>,
    capacity: u64,
}

#[derive(Debug)]
struct Inner<T> {
    queue: VecDeque<(u64, T)>,
    weight: u64,
    waker: Option<Waker>,
}

impl<T> Mailbox<T> {
    pub(super) fn new(capacity: u64) -> Self {
        Mailbox { inner: Mutex::new(Inner { queue: VecDeque::new(), weight: 0, waker: None }), capacity }
    }

    /// Adds an item. An item of weight 0 always fits. Returns false if the item was dropped.
    pub(super) fn push(&self, weight: u64, item: T) -> bool {
        let mut inner = self.lock();
        if weight > 0 && inner.weight + weight > self.capacity {
            return false;
        }
        inner.weight += weight;
        inner.queue.push_back((weight, item));
        let waker = inner.waker.take();
        drop(inner);
        if let Some(waker) = waker {
            waker.wake();
        }
        true
    }

    pub(super) fn poll(&self, cx: &mut Context<'_>) -> Poll<T> {
        let mut inner = self.lock();
        match inner.queue.pop_front() {
            Some((weight, item)) => {
                inner.weight -= weight;
                Poll::Ready(item)
            }
            None => {
                inner.waker = Some(cx.waker().clone());
                Poll::Pending
            }
        }
    }

    fn lock(&self) -> MutexGuard<'_, Inner<T>> {
        self.inner.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_bounded_by_weight_but_takes_what_weighs_nothing() {
        let mailbox = Mailbox::new(10);
        assert!(mailbox.push(6, 'a'));
        assert!(!mailbox.push(5, 'b'));
        assert!(mailbox.push(0, 'c'));
        assert!(mailbox.push(4, 'd'));
        let cx = &mut Context::from_waker(Waker::noop());
        assert_eq!([(); 3].map(|()| mailbox.poll(cx)), ['a', 'c', 'd'].map(Poll::Ready));
        assert!(mailbox.poll(cx).is_pending());
        assert!(mailbox.push(10, 'e'));
    }
}
