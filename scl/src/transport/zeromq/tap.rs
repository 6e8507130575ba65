//! The listening end of a tap: an XPUB socket to its observers.

use super::TransportKind;
use super::acceptor::Acceptor;
use super::session::{Closed, Session};
use super::subscribers::{Subscriber, Subscribers};
use super::topics::Topics;
use super::zmtp::{Header, MORE, SclReady, SocketType};
use crate::runtime_dir::SystemDir;
use crate::transport::{self, Endpoint, TransportError};
use bytes::{BufMut, Bytes, BytesMut};
use std::collections::VecDeque;
use std::sync::Arc;
use std::task::{Context, Poll};

/// Maximum number of messages that wait for a slow observer, and of bytes; one message may always wait. Enough for a
/// recorder whose disk blocks it for half a second while ten gates at 1 kHz, or one in bursts, keep sending.
const MOST_WAITING: usize = 8192;
const MOST_BYTES: usize = 16 << 20;

pub(super) struct Tap {
    subscribers: Subscribers,
    observers: Vec<Observer>,
    /// The last message of a latched gate, encoded, with its payload.
    latched: Option<(Bytes, Bytes)>,
    /// Memory for encoded messages.
    encoded: BytesMut,
    dropped: u64,
}

struct Observer {
    session: Session,
    topics: Topics,
    waiting: VecDeque<Bytes>,
    bytes: usize,
}

impl Tap {
    pub(super) fn open(dir: &Arc<SystemDir>, kind: TransportKind, endpoint: &Endpoint) -> Result<Self, TransportError> {
        let acceptor = Acceptor::open(dir, kind, endpoint, SocketType::XPub, SclReady::default())?;
        let (subscribers, observers, encoded) = (Subscribers::new(acceptor), Vec::new(), BytesMut::new());
        Ok(Self { subscribers, observers, latched: None, encoded, dropped: 0 })
    }

    fn accept(&mut self, cx: &mut Context<'_>) {
        while let Poll::Ready(subscriber) = self.subscribers.poll_next(cx, self.observers.len()) {
            let Subscriber { session, topics, .. } = subscriber;
            let mut observer = Observer { session, topics, waiting: VecDeque::new(), bytes: 0 };
            if let Some((payload, message)) = &self.latched
                && observer.topics.matches(payload)
            {
                observer.queue(message.clone());
            }
            self.observers.push(observer);
        }
    }

    /// Calls `act` with each observer, and drops those that are gone.
    fn with_each(&mut self, mut act: impl FnMut(&mut Observer) -> Result<(), Closed>) {
        self.observers.retain_mut(|observer| {
            act(observer).inspect_err(|error| tracing::debug!(%error, "an observer left")).is_ok()
        });
    }

    fn encode(&mut self, payload: &Bytes, meta: &[u8]) -> Bytes {
        self.encoded.reserve(payload.len() + meta.len() + 18);
        for (flags, body) in [(MORE, &payload[..]), (0, meta)] {
            self.encoded.put_slice(Header::new(flags, body.len()).as_bytes());
            self.encoded.put_slice(body);
        }
        self.encoded.split().freeze()
    }
}

impl transport::Tap for Tap {
    fn drive(&mut self, cx: &mut Context<'_>) -> bool {
        self.accept(cx);
        self.with_each(|observer| observer.drive(cx));
        !self.observers.is_empty()
    }

    fn observe(&mut self, cx: &mut Context<'_>, payload: &Bytes, meta: &[u8]) {
        if self.observers.is_empty() {
            return;
        }
        let message = self.encode(payload, meta);
        let mut dropped = 0;
        self.with_each(|observer| {
            if observer.topics.matches(payload) {
                dropped += observer.queue(message.clone());
                observer.write_on(cx)?;
            }
            Ok(())
        });
        self.dropped += dropped;
    }

    fn latch(&mut self, payload: &Bytes, meta: &[u8]) {
        self.latched = Some((payload.clone(), self.encode(payload, meta)));
    }

    fn dropped(&self) -> u64 {
        self.dropped
    }
}

impl Observer {
    fn drive(&mut self, cx: &mut Context<'_>) -> Result<(), Closed> {
        while let Poll::Ready(item) = self.session.poll_item(cx) {
            if let Some(subscription) = item?.into_subscription() {
                self.topics.handle(subscription)?;
            }
        }
        self.write_on(cx)
    }

    /// Queues a message, and returns how many older ones were dropped for it.
    fn queue(&mut self, message: Bytes) -> u64 {
        let mut dropped = 0;
        while self.waiting.len() >= MOST_WAITING || self.bytes + message.len() > MOST_BYTES {
            let Some(oldest) = self.waiting.pop_front() else { break };
            self.bytes -= oldest.len();
            dropped += 1;
        }
        self.bytes += message.len();
        self.waiting.push_back(message);
        dropped
    }

    fn write_on(&mut self, cx: &mut Context<'_>) -> Result<(), Closed> {
        self.session.flush(cx)?;
        while self.session.is_written()
            && let Some(message) = self.waiting.pop_front()
        {
            self.bytes -= message.len();
            self.session.write_shared(message)?;
            self.session.flush(cx)?;
        }
        Ok(())
    }
}
