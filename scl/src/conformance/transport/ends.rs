//! Sending and receiving ends, as the tests use them.

use super::watched::Watched;
use crate::transport::{Driven, Frame, Link, PeerKind, Receiver, Sender, Sent};
use bytes::Bytes;
use std::collections::VecDeque;
use std::future::poll_fn;
use std::task::{Context, Poll, Waker};
use std::time::Duration;

/// More peers than any test opens.
const MOST_PEERS: usize = 10_000;

/// A sending end, its newest link, and the messages to send over that.
pub(super) struct TestSender {
    pub(super) watched: Watched<Box<dyn Sender>>,
    pub(super) link: Option<TestLink>,
    queue: VecDeque<Frame>,
    /// Number of peers so far.
    peers: usize,
}

impl TestSender {
    pub(super) fn new(end: Box<dyn Sender>) -> Self {
        Self { watched: Watched::new(end), link: None, queue: VecDeque::new(), peers: 0 }
    }

    pub(super) fn renew_waker(&mut self) {
        self.watched.renew_waker();
        self.link.iter_mut().for_each(|link| link.watched.renew_waker());
    }

    /// How often the end and its link were woken.
    pub(super) fn wakes(&self) -> (usize, usize) {
        (self.watched.wakes(), self.link.as_ref().map_or(0, |link| link.watched.wakes()))
    }

    pub(super) fn peers(&self) -> usize {
        self.peers
    }

    pub(super) fn queue(&mut self, messages: impl IntoIterator<Item = Bytes>) {
        self.queue.extend(messages.into_iter().map(Frame::from));
    }

    /// Queues one frame.
    pub(super) fn queue_frame(&mut self, frame: Frame) {
        self.queue.push_back(frame);
    }

    /// Sends `message` instead of those that are still waiting.
    pub(super) fn replace(&mut self, message: Bytes) {
        self.queue.clear();
        self.queue.push_back(message.into());
    }

    pub(super) fn waiting(&self) -> usize {
        self.queue.len()
    }

    /// Returns true if all messages were sent and written.
    pub(super) fn is_written(&self) -> bool {
        self.queue.is_empty() && self.link.as_ref().is_none_or(|link| link.watched.end.is_written())
    }

    /// Polls for peers and drives the link, each only if it was woken, then sends the queued messages. Returns true if
    /// a peer is connected.
    pub(super) fn poll(&mut self, test: &Context<'_>) -> bool {
        loop {
            while let Poll::Ready(link) = self.poll_link(test) {
                self.link = Some(link);
            }
            let Some(link) = &mut self.link else { return false };
            if link.poll(test, &mut self.queue) {
                return true;
            }
            self.drop_link();
        }
    }

    /// Returns the link to the next peer.
    pub(super) fn poll_link(&mut self, test: &Context<'_>) -> Poll<TestLink> {
        self.watched.poll_with(test, |end, cx| end.poll_peer(cx)).map(|peer| {
            assert_eq!(peer.kind, PeerKind::Component, "an end of this transport is taken for a foreign program");
            self.peers += 1;
            assert!(self.peers < MOST_PEERS, "a sending end never stops returning peers");
            TestLink::new(peer.link)
        })
    }

    pub(super) fn drop_link(&mut self) {
        self.link = None;
        self.watched.call_again();
    }

    /// Waits until a peer is connected, or until none is if `connected` is false.
    pub(super) async fn until_connected(&mut self, connected: bool) {
        poll_fn(|cx| if self.poll(cx) == connected { Poll::Ready(()) } else { Poll::Pending }).await;
    }

    /// Waits until all messages are written to the connected peer.
    pub(super) async fn until_written(&mut self) {
        poll_fn(|cx| {
            self.poll(cx);
            if self.is_written() { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
    }

    pub(super) fn detach(&mut self) {
        self.watched.end.detach();
        self.link.iter_mut().for_each(|link| link.watched.end.detach());
    }

    /// Does what [`poll`](Self::poll) does, but without waiting for a wake-up and without a waker.
    pub(super) fn turn_detached(&mut self) -> bool {
        self.watched.use_no_waker();
        self.link.iter_mut().for_each(|link| link.watched.use_no_waker());
        let had_link = self.link.is_some();
        let connected = self.poll(&Context::from_waker(Waker::noop()));
        if connected && !had_link {
            self.link.iter_mut().for_each(|link| link.watched.end.detach());
        }
        connected
    }
}

/// The connection of a sending end to one peer.
pub(super) struct TestLink {
    pub(super) watched: Watched<Box<dyn Link>>,
    /// A message was returned since the link was last woken.
    refused: bool,
    /// The last message was returned because the peer was gone.
    is_gone: bool,
    turns: usize,
}

impl TestLink {
    fn new(end: Box<dyn Link>) -> Self {
        Self { watched: Watched::new(end), refused: false, is_gone: false, turns: 0 }
    }

    /// Drives the link if it was woken, and sends from the queue. A message that was returned is sent again only after
    /// a wake-up. Returns false if the peer is gone.
    pub(super) fn poll(&mut self, test: &Context<'_>, queue: &mut VecDeque<Frame>) -> bool {
        let mut driven = None;
        if self.watched.take_turn(test) {
            driven = self.watched.end.drive(&mut Context::from_waker(&self.watched.waker)).ok();
            if driven.is_none() {
                return false;
            }
            assert!(!self.is_gone, "`send` returned a message because the peer was gone, then `drive` succeeded");
            self.refused = false;
        }
        if driven.is_some() || (!self.refused && !queue.is_empty()) {
            // Gates send single messages and several at once, in any order.
            self.turns += 1;
            if self.turns.is_multiple_of(2) {
                while self.send_one(queue) {}
            }
            self.send_all(driven, queue);
        }
        true
    }

    /// Returns true if a message was sent.
    fn send_one(&mut self, queue: &mut VecDeque<Frame>) -> bool {
        let Some(message) = queue.pop_front() else { return false };
        let sent = message.to_bytes();
        let result = self.watched.end.send(&mut Context::from_waker(&self.watched.waker), message);
        self.is_gone |= matches!(result, Sent::Gone(_));
        if let Some(returned) = result.returned() {
            assert!(returned.as_slice() == sent, "`send` returned a different message from the one it refused");
            queue.push_front(returned);
            return false;
        }
        true
    }

    fn send_all(&mut self, driven: Option<Driven>, queue: &mut VecDeque<Frame>) {
        let cx = &mut Context::from_waker(&self.watched.waker);
        let before: Vec<Bytes> = queue.iter().map(Frame::to_bytes).collect();
        let mut lengths = Vec::new();
        self.watched.end.send_all(cx, driven, queue, &mut |length| lengths.push(length));
        let sent = before.len() - queue.len();
        assert!(
            before[sent..].iter().eq(queue.iter().map(Frame::as_slice)),
            "`send_all` changed messages that it left in the queue"
        );
        let expected = before[..sent].iter().map(Bytes::len);
        assert!(expected.eq(lengths), "`send_all` reported lengths that differ from those of the messages it sent");
        self.refused = !queue.is_empty();
    }

    pub(super) fn request_acknowledgement(&mut self) {
        self.watched.end.request_acknowledgement(&mut Context::from_waker(&self.watched.waker));
    }

    /// Returns the number of messages that the peer's program has not received, as the peer reported before it
    /// disconnected.
    pub(super) fn not_received_at_last(&mut self) -> u64 {
        self.watched.end.read_last();
        self.watched.end.not_received()
    }
}

/// A receiving end.
pub(super) struct TestReceiver {
    pub(super) watched: Watched<Box<dyn Receiver>>,
    /// What [`poll_newest`](Self::poll_newest) has received and not returned yet.
    newest: Option<Bytes>,
    /// Whether a pending [`poll_newest`](Self::poll_newest) is continued by the next one.
    catching_up: bool,
}

impl TestReceiver {
    pub(super) fn new(end: Box<dyn Receiver>) -> Self {
        Self { watched: Watched::new(end), newest: None, catching_up: false }
    }

    /// Drops the end as a gate does while the last `waiting` messages that were returned wait in its queue.
    pub(super) fn leave(mut self, waiting: u64) {
        let _awaited = self.watched.end.note_waiting(&mut Context::from_waker(&self.watched.waker), waiting);
        self.watched.end.acknowledge_last();
    }

    pub(super) fn poll(&mut self, test: &Context<'_>) -> Poll<Bytes> {
        self.watched.poll_with(test, |end, cx| end.poll_recv(cx))
    }

    /// Lets the end connect, without asking it for a message.
    pub(super) fn connect(&mut self, test: &Context<'_>) {
        if self.watched.take_turn(test) {
            self.watched.end.connect(&mut Context::from_waker(&self.watched.waker));
        }
    }

    /// Returns the newest message, or `None` if there is none since the last call, once the sender has nothing newer.
    pub(super) fn poll_newest(&mut self, test: &Context<'_>) -> Poll<Option<Bytes>> {
        let (newest, catching_up) = (&mut self.newest, &mut self.catching_up);
        self.watched.poll_with(test, |end, cx| {
            while let Poll::Ready(message) = end.poll_recv(cx) {
                *newest = Some(message);
            }
            if !std::mem::replace(catching_up, true) {
                end.forget_answers();
            }
            let caught_up = end.poll_caught_up(cx);
            while let Poll::Ready(message) = end.poll_recv(cx) {
                *newest = Some(message);
            }
            *catching_up = caught_up.is_pending();
            caught_up.map(|()| newest.take())
        })
    }

    /// Waits for the next message, polling senders too.
    pub(super) async fn next(&mut self, senders: &mut [&mut TestSender]) -> Bytes {
        poll_fn(|cx| {
            for sender in &mut *senders {
                sender.poll(cx);
            }
            self.poll(cx)
        })
        .await
    }

    /// Receives the messages that have arrived, without a runtime. Waits up to `within` for those that the sender holds
    /// back.
    pub(super) fn fetch(&mut self, within: Duration) -> Vec<Bytes> {
        self.watched.end.catch_up(within);
        self.watched.call_again();
        let mut cx = Context::from_waker(Waker::noop());
        let mut messages = Vec::new();
        while let Poll::Ready(message) = self.watched.end.poll_recv(&mut cx) {
            messages.push(message);
        }
        messages
    }
}
