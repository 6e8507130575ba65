//! The last message of a connection with `latched: true`, for a subscriber that joins later.

use super::queue::{Pushed, Queue};
use crate::transport::{Frame, Resumed};
use bytes::Bytes;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

#[derive(Default)]
pub(super) struct Latch {
    /// The last message, and when it was sent.
    last: Option<(Bytes, Instant)>,
    /// Whether it was put into the queue. It then stays at the back until it is handed over.
    is_queued: bool,
    /// Whether the queue has dropped it.
    is_dropped: bool,
    /// Whether the connected subscriber has joined since it was sent.
    has_joined: bool,
    /// How the subscriber introduced itself when it connected; after it has disconnected, how it would if it
    /// reconnected now.
    peer: Option<Resumed>,
    /// How many messages this connection had handed over when that subscriber connected.
    handed: u64,
}

impl Latch {
    /// Keeps the message that is being sent.
    pub(super) fn keep(&mut self, message: &Frame) {
        self.last = Some((message.to_bytes(), Instant::now()));
        (self.is_queued, self.is_dropped, self.has_joined) = (false, false, false);
    }

    /// Notes whether the queue has stored or dropped the message sent last.
    pub(super) fn note_queued(&mut self, pushed: Pushed) {
        (self.is_queued, self.is_dropped) = (pushed != Pushed::Dropped, pushed == Pushed::Dropped);
    }

    /// Called when a subscriber connects. Puts the last message into the queue, unless it is there already, or the
    /// subscriber has it because it merely reconnects. Returns true if it was put there, to be sent over this
    /// connection once more.
    pub(super) fn join(&mut self, queue: &mut Queue<Frame>, peer: Option<Resumed>, handed: u64) -> bool {
        let before = std::mem::replace(&mut self.peer, peer);
        self.handed = handed;
        let Some((last, _)) = &self.last else { return false };
        self.is_queued &= !queue.is_empty();
        let is_missing = !self.is_queued && (self.is_dropped || peer.is_none() || peer != before);
        if is_missing {
            queue.push_back(last.clone().into());
            (self.is_queued, self.is_dropped) = (true, false);
        }
        self.has_joined = self.is_queued;
        is_missing
    }

    /// Called when the subscriber has disconnected.
    pub(super) fn leave(&mut self, handed: u64) {
        if let Some(peer) = &mut self.peer {
            peer.taken += handed - self.handed;
        }
        self.handed = handed;
    }

    /// Appends the last message, unless it is there already, to `waiting`, which a plain ZeroMQ subscriber gets first.
    pub(super) fn join_foreign(&self, waiting: &mut VecDeque<Frame>) {
        if let Some((last, _)) = &self.last
            && (waiting.is_empty() || !self.is_queued)
        {
            waiting.push_back(last.clone().into());
        }
    }

    /// Takes the last message from the back of the queue, with its age, if the subscriber is to be told that it is old.
    pub(super) fn take_joined(&self, queue: &mut Queue<Frame>) -> Option<(Frame, Duration)> {
        let (_, sent) = self.last.as_ref().filter(|_| self.has_joined)?;
        Some((queue.pop_back()?, sent.elapsed()))
    }

    /// Called when the last message was sent to the subscriber that has joined.
    pub(super) fn note_sent(&mut self) {
        (self.is_queued, self.has_joined) = (false, false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gate::queue::QueuePolicy;
    use crate::spec::WhenFull;

    fn latch_with(message: &'static [u8]) -> Latch {
        let mut latch = Latch::default();
        latch.keep(&Bytes::from_static(message).into());
        latch
    }

    fn queue(when_full: WhenFull) -> Queue<Frame> {
        Queue::new(QueuePolicy { capacity: 2, when_full })
    }

    #[test]
    fn a_message_that_a_full_queue_dropped_comes_behind_those_that_wait() {
        // The second subscriber merely reconnects, and has everything that was handed over: nothing.
        for peer in [None, Some(Resumed { end: 7, taken: 0 })] {
            let mut queue = queue(WhenFull::DropNewest);
            let mut latch = Latch { peer, ..Latch::default() };
            for message in ["0", "1", "2"] {
                let frame = Frame::from(Bytes::from_static(message.as_bytes()));
                latch.keep(&frame);
                latch.note_queued(queue.push(frame));
            }
            assert!(latch.join(&mut queue, peer, 0), "sent although it was dropped");
            let (last, _age) = latch.take_joined(&mut queue).unwrap();
            assert_eq!((last.as_slice(), queue.len()), (&b"2"[..], 2));
        }
    }

    #[test]
    fn a_subscriber_that_reconnects_gets_only_what_it_has_not_taken() {
        let ends = |end, taken| Some(Resumed { end, taken });
        // What it says when it reconnects, after 3 of 3 messages were handed over, and whether the last is sent again.
        for (says, again) in [(ends(7, 13), false), (ends(7, 12), true), (ends(8, 13), true), (None, true)] {
            let (mut latch, mut queue) = (latch_with(b"last"), queue(WhenFull::DropOldest));
            assert!(latch.join(&mut queue, ends(7, 10), 0));
            queue.pop();
            latch.note_sent();
            latch.leave(3);
            assert_eq!(latch.join(&mut queue, says, 3), again, "{says:?}");
            assert_eq!(queue.len(), usize::from(again));
        }
    }

    #[test]
    fn a_newer_message_is_not_old() {
        let (mut latch, mut queue) = (latch_with(b"old"), queue(WhenFull::DropOldest));
        assert!(latch.join(&mut queue, None, 0));
        latch.keep(&Bytes::from_static(b"new").into());
        assert!(latch.take_joined(&mut queue).is_none());
    }
}
