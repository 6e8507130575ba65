//! The observing end of a tap: a SUB socket that reads messages of two frames.

use super::dialler::Dialler;
use super::session::{Closed, Session};
use super::zmtp::{Command, Item, Message, SUBSCRIBE_ALL_AND_PING, SclReady, SocketType, bodies};
use crate::observation::{Observation, TapEvent};
use crate::runtime_dir::SystemDir;
use crate::tap_meta::{TapMeta, now_ns};
use crate::transport::Endpoint;
use bytes::Bytes;
use std::sync::Arc;
use std::task::{Context, Poll, ready};

/// The longest message that is read: the largest `max_size` of a gate. Memory is reserved as bytes arrive.
const MAX_SIZE: usize = 1 << 30;

pub(crate) struct TapReader {
    dialler: Dialler,
    tap: Option<Subscribed>,
    rejected: u64,
}

/// A connection on which everything has been subscribed to.
struct Subscribed {
    session: Session,
    /// Whether the tap has confirmed the subscription, and the observer was told.
    is_confirmed: bool,
    /// The message that has confirmed the subscription, unless the answer to the heartbeat has.
    first: Option<Observation>,
}

impl TapReader {
    /// Opens the observing end of a tap. Called inside a runtime.
    pub(crate) fn open(dir: &Arc<SystemDir>, endpoint: String) -> Self {
        let endpoint = Endpoint { max_size: MAX_SIZE, ..Endpoint::new(endpoint) };
        Self { dialler: Dialler::new(dir, &endpoint, SocketType::Sub, SclReady::default()), tap: None, rejected: 0 }
    }

    pub(crate) fn endpoint(&self) -> &str {
        &self.dialler.endpoint.name
    }

    pub(crate) fn rejected(&self) -> u64 {
        self.rejected
    }

    pub(crate) fn poll_next(&mut self, cx: &mut Context<'_>) -> Poll<TapEvent> {
        loop {
            let Some(tap) = &mut self.tap else {
                let (session, _ready) = ready!(self.dialler.poll_connected(cx));
                self.tap = Some(Subscribed::new(session));
                continue;
            };
            match ready!(tap.poll_event(&mut self.rejected, cx)) {
                Ok(event) => return Poll::Ready(event),
                Err(error) => {
                    tracing::debug!(endpoint = %self.dialler.endpoint.name, %error, "lost the tap");
                    if self.tap.take().is_some_and(|tap| tap.is_confirmed) {
                        return Poll::Ready(TapEvent::Disconnected);
                    }
                }
            }
        }
    }
}

impl Subscribed {
    fn new(mut session: Session) -> Self {
        // Not sent earlier: libzmq closes a connection on which this arrives together with READY.
        let _reported_by_reading = session.write(SUBSCRIBE_ALL_AND_PING);
        Self { session, is_confirmed: false, first: None }
    }

    fn poll_event(&mut self, rejected: &mut u64, cx: &mut Context<'_>) -> Poll<Result<TapEvent, Closed>> {
        if let Some(first) = self.first.take() {
            return Poll::Ready(Ok(TapEvent::Observed(first)));
        }
        loop {
            let said = ready!(self.poll_said(rejected, cx))?;
            let was_confirmed = std::mem::replace(&mut self.is_confirmed, true);
            if !was_confirmed {
                self.first = said;
                return Poll::Ready(Ok(TapEvent::Connected));
            }
            if let Some(observed) = said {
                return Poll::Ready(Ok(TapEvent::Observed(observed)));
            }
        }
    }

    /// Returns the next message, or `None` for the answer to the heartbeat.
    fn poll_said(&mut self, rejected: &mut u64, cx: &mut Context<'_>) -> Poll<Result<Option<Observation>, Closed>> {
        loop {
            if !self.session.is_written() {
                self.session.flush(cx)?;
            }
            match ready!(self.session.poll_item(cx))? {
                Item::Command(Command::Pong) => return Poll::Ready(Ok(None)),
                Item::Message(message) => match decode(&message) {
                    None => *rejected += 1,
                    observed => return Poll::Ready(Ok(observed)),
                },
                Item::Command(_) | Item::Ready(_) => {}
            }
        }
    }
}

/// Returns the payload with what `GateTap` reports about it, or `None` for any other message.
fn decode(message: &Message) -> Option<Observation> {
    let mut frames = bodies(&message.envelope);
    let (payload, None) = (frames.next()?, frames.next()) else { return None };
    let TapMeta { sequence, sent_ns, call_id, kind, latched } = TapMeta::decode(message.body[..].try_into().ok()?)?;
    let payload = if payload.is_empty() { Bytes::new() } else { message.envelope.slice_ref(payload) };
    Some(Observation { payload, sequence, sent_ns, received_ns: now_ns(), call_id, latched, kind })
}
