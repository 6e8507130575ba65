//! The listening end of a tap: an XPUB socket to its observers.

use super::Medium;
use super::acceptor::Acceptor;
use super::connection::{Closed, Connection};
use super::publish::poll_subscribed;
use super::topics::Topics;
use super::zmtp::{COMMAND_LIMIT, Header, MORE, SclReady, SocketType};
use crate::runtime_dir::SystemDir;
use crate::transport::{self, Endpoint, TransportError};
use bytes::{BufMut, Bytes, BytesMut};
use std::collections::VecDeque;
use std::sync::Arc;
use std::task::{Context, Poll};

/// How many messages wait for an observer that reads slowly, and how many bytes; one message may always wait. Enough for a
/// recorder that is held up by its disk for half a second while ten gates at 1 kHz, or one in bursts, go on.
const MOST_WAITING: usize = 8192;
const MOST_BYTES: usize = 16 << 20;

pub(super) struct Tap {
    acceptor: Acceptor,
    /// Connections that have not subscribed to anything yet.
    unsubscribed: Vec<Connection>,
    observers: Vec<Observer>,
    /// Memory for encoded messages.
    encoded: BytesMut,
    dropped: u64,
}

struct Observer {
    connection: Connection,
    topics: Topics,
    waiting: VecDeque<Bytes>,
    bytes: usize,
}

impl Tap {
    pub(super) fn open(dir: &Arc<SystemDir>, medium: Medium, endpoint: &Endpoint) -> Result<Self, TransportError> {
        let endpoint = Endpoint { max_size: COMMAND_LIMIT, ..endpoint.clone() };
        let acceptor = Acceptor::open(dir, medium, &endpoint, SocketType::XPub, SclReady::default())?;
        Ok(Self { acceptor, unsubscribed: Vec::new(), observers: Vec::new(), encoded: BytesMut::new(), dropped: 0 })
    }

    fn accept(&mut self, cx: &mut Context<'_>) {
        loop {
            let open = self.unsubscribed.len() + self.observers.len();
            let Poll::Ready((connection, _)) = self.acceptor.poll_connection(cx, open) else { break };
            self.unsubscribed.push(connection);
        }
        let mut index = 0;
        while let Some(connection) = self.unsubscribed.get_mut(index) {
            match poll_subscribed(connection, cx) {
                Poll::Ready(Ok(topics)) => {
                    let connection = self.unsubscribed.swap_remove(index);
                    self.observers.push(Observer { connection, topics, waiting: VecDeque::new(), bytes: 0 });
                }
                Poll::Ready(Err(error)) => {
                    tracing::debug!(%error, "an observer left");
                    self.unsubscribed.swap_remove(index);
                }
                Poll::Pending => index += 1,
            }
        }
    }

    /// Does something with each observer, and drops those that are gone.
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

    fn dropped(&self) -> u64 {
        self.dropped
    }
}

impl Observer {
    fn drive(&mut self, cx: &mut Context<'_>) -> Result<(), Closed> {
        while let Poll::Ready(item) = self.connection.poll_item(cx) {
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
        self.connection.flush(cx)?;
        while self.connection.is_written()
            && let Some(message) = self.waiting.pop_front()
        {
            self.bytes -= message.len();
            self.connection.write_shared(message)?;
            self.connection.flush(cx)?;
        }
        Ok(())
    }
}
