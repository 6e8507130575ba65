//! The sending ends: publish and push.

use super::lend::Lender;
use super::pipe::{PipeReader, PipeWriter};
use super::switchboard::{Connector, Listener};
use crate::transport::link_count::{LinkAlive, LinkCount};
use crate::transport::{Disconnected, Driven, Frame, Link, Loan, Peer, PeerKind, Sender, Sent};
use bytes::Bytes;
use std::collections::VecDeque;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::{Duration, Instant};

/// A publisher.
impl Sender for Listener<PipeWriter<Bytes>, PipeReader<Bytes>> {
    fn poll_peer(&mut self, cx: &mut Context<'_>) -> Poll<Peer> {
        loop {
            let subscriber = ready!(self.poll_connection(cx));
            if subscriber.is_open() {
                return Poll::Ready(peer(MemoryLink::new(subscriber, None)));
            }
        }
    }
}

pub(super) struct Pusher {
    puller: Connector<PipeReader<Bytes>, PipeWriter<Bytes>>,
    links: Arc<LinkCount>,
}

impl Pusher {
    pub(super) fn new(puller: Connector<PipeReader<Bytes>, PipeWriter<Bytes>>) -> Self {
        Self { puller, links: Arc::default() }
    }
}

impl Sender for Pusher {
    fn poll_peer(&mut self, cx: &mut Context<'_>) -> Poll<Peer> {
        if self.links.count() > 0 {
            return Poll::Pending;
        }
        loop {
            let puller = ready!(self.puller.poll_connection(cx));
            if puller.is_open() {
                // After the link is dropped, connect to the same puller again.
                self.puller.connect_again();
                return Poll::Ready(peer(MemoryLink::new(puller, Some(self.links.new_link()))));
            }
        }
    }

    fn refusal(&self) -> Option<String> {
        self.puller.refusal()
    }
}

fn peer(link: MemoryLink) -> Peer {
    Peer { kind: PeerKind::Component, link: Box::new(link) }
}

struct MemoryLink {
    pipe: PipeWriter<Bytes>,
    lender: Lender,
    _alive: Option<LinkAlive>,
}

impl MemoryLink {
    fn new(pipe: PipeWriter<Bytes>, alive: Option<LinkAlive>) -> Self {
        Self { pipe, lender: Lender::default(), _alive: alive }
    }

    fn send_item(&mut self, cx: &mut Context<'_>, message: Frame, time: Option<Instant>) -> Sent {
        // Return a loan that cannot be sent yet as a loan, not as bytes.
        if matches!(message, Frame::Loan(_)) && !self.pipe.has_room(cx) {
            return Sent::Full(message);
        }
        self.sent(self.pipe.send(cx, self.lender.take_back(message), time.map(|time| (time, false))))
    }

    fn sent(&self, sent: Result<(), Bytes>) -> Sent {
        match sent {
            Ok(()) => Sent::Sent,
            Err(message) if self.pipe.is_open() => Sent::Full(message.into()),
            Err(message) => Sent::Gone(message.into()),
        }
    }
}

impl Link for MemoryLink {
    fn drive(&mut self, cx: &mut Context<'_>) -> Result<Driven, Disconnected> {
        if self.pipe.poll_open(cx) { Ok(Driven::default()) } else { Err(Disconnected) }
    }

    fn send(&mut self, cx: &mut Context<'_>, message: Frame) -> Sent {
        self.send_item(cx, message, None)
    }

    fn send_timed(&mut self, cx: &mut Context<'_>, message: Frame, sent: Instant) -> Sent {
        self.send_item(cx, message, Some(sent))
    }

    fn send_all_timed(
        &mut self,
        cx: &mut Context<'_>,
        driven: Option<Driven>,
        queue: &mut VecDeque<Frame>,
        times: &mut VecDeque<Instant>,
        sent: &mut dyn FnMut(usize),
    ) {
        debug_assert_eq!(queue.len(), times.len(), "each message has its time");
        while let Some(time) = times.front()
            && let Some(message) = queue.pop_front()
        {
            let length = message.len();
            match self.send_timed(cx, message, *time).returned() {
                None => sent(length),
                Some(message) => return queue.push_front(message),
            }
            times.pop_front();
        }
        // An empty queue tells the reader that nothing is held back.
        self.send_all(cx, driven, queue, sent);
    }

    fn send_latched(&mut self, cx: &mut Context<'_>, message: Frame, age: Duration) -> Sent {
        let sent = Instant::now().checked_sub(age);
        self.sent(self.pipe.send(cx, message.into_bytes(), sent.map(|sent| (sent, true))))
    }

    fn send_all(
        &mut self,
        cx: &mut Context<'_>,
        _driven: Option<Driven>,
        queue: &mut VecDeque<Frame>,
        sent: &mut dyn FnMut(usize),
    ) {
        let to_item = |message| self.lender.take_back(message);
        self.pipe.send_all(cx, queue, to_item, |message| sent(message.len()));
    }

    fn loan(&mut self, length: usize) -> Option<Loan> {
        Some(self.lender.lend(length))
    }

    /// Always returns true, because what was sent can be received even after this end is dropped.
    fn is_written(&self) -> bool {
        true
    }

    fn unacknowledged(&self) -> u64 {
        self.pipe.untaken()
    }

    fn not_received(&self) -> u64 {
        self.pipe.not_received()
    }

    fn request_acknowledgement(&mut self, cx: &mut Context<'_>) {
        self.pipe.wake_when_empty(cx);
    }
}
