//! The replying end, which accepts any number of requesters: a ROUTER socket to them.
//!
//! A reply goes back over the connection of its request, so there is no table of requesters. A request keeps its frames
//! up to the empty one as they came, and the reply repeats them.

use super::TransportKind;
use super::acceptor::Acceptor;
use super::session::{Closed, Session};
use super::zmtp::{Header, Item, Message, ProtocolError, SclReady, SocketType, bodies, refused};
use crate::runtime_dir::SystemDir;
use crate::sync::{keep_waker, lock};
use crate::transport::round_robin::RoundRobin;
use crate::transport::{Endpoint, IncomingRequest, Replier, ReplyPath, RequesterGone, TransportError};
use bytes::Bytes;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker, ready};

pub(super) struct ReplyingEnd {
    acceptor: Acceptor,
    requesters: RoundRobin<Arc<Mutex<Exchange>>>,
    malformed: u64,
}

/// The state of the connection to one requester.
struct Exchange {
    /// `None` once the connection has broken or the replying end was dropped.
    session: Option<Session>,
    /// Whether the requester understands SCL's commands.
    is_scl: bool,
    /// How many requests the requester may have sent without a reply, if more than one.
    in_flight: usize,
    /// A request that was read while looking for commands, which are handled also while the program takes no requests.
    ahead: Option<Message>,
    /// The task of the replying end, to be woken for what a reply could not write.
    task: Option<Waker>,
}

impl ReplyingEnd {
    pub(super) fn open(dir: &Arc<SystemDir>, kind: TransportKind, endpoint: &Endpoint) -> Result<Self, TransportError> {
        let acceptor = Acceptor::open(dir, kind, endpoint, SocketType::Router, SclReady::default())?;
        Ok(Self { acceptor, requesters: RoundRobin::new(1), malformed: 0 })
    }

    fn accept(&mut self, cx: &mut Context<'_>) {
        while let Poll::Ready((session, ready)) = self.acceptor.poll_session(cx, self.requesters.connections.len()) {
            let in_flight = ready.scl.and_then(|scl| scl.in_flight).unwrap_or(0);
            let is_scl = ready.scl.is_some();
            let exchange = Exchange { session: Some(session), is_scl, in_flight, ahead: None, task: None };
            self.requesters.connections.push(Arc::new(Mutex::new(exchange)));
        }
    }
}

impl Replier for ReplyingEnd {
    fn poll_request(&mut self, cx: &mut Context<'_>) -> Poll<IncomingRequest> {
        loop {
            let malformed = &mut self.malformed;
            let polled = self.requesters.poll(|client| {
                let mut exchange = lock(client);
                exchange.poll_request(cx, malformed).map(|request| {
                    let (envelope, body) = request.inspect_err(|error| exchange.lose(error)).ok()?;
                    Some(IncomingRequest { body, envelope, path: Arc::clone(client) as Arc<dyn ReplyPath> })
                })
            });
            if polled.is_ready() {
                return polled;
            }
            let before = self.requesters.connections.len();
            self.accept(cx);
            // The connections polled above will wake the task, but new ones have to be polled first.
            if self.requesters.connections.len() == before {
                return Poll::Pending;
            }
        }
    }

    fn drive(&mut self, cx: &mut Context<'_>) -> bool {
        self.accept(cx);
        let mut is_written = true;
        self.requesters.connections.retain(|client| {
            let mut exchange = lock(client);
            let driven = exchange.drive(cx);
            is_written &= *driven.as_ref().unwrap_or(&true);
            driven.inspect_err(|error| exchange.lose(error)).is_ok()
        });
        is_written
    }

    fn peers(&self) -> usize {
        self.requesters.connections.len()
    }

    fn malformed(&self) -> u64 {
        self.malformed
    }

    fn detach(&mut self) {
        self.acceptor.detach();
        for client in &self.requesters.connections {
            if let Some(session) = &mut lock(client).session {
                session.detach();
            }
        }
    }
}

impl Drop for ReplyingEnd {
    fn drop(&mut self) {
        // Requests that are not answered yet must not keep connections open.
        for client in &self.requesters.connections {
            lock(client).session = None;
        }
    }
}

impl Exchange {
    fn lose(&mut self, error: &Closed) {
        tracing::debug!(%error, "a requester left");
        self.session = None;
    }

    fn prepare(&mut self, cx: &mut Context<'_>) -> Result<&mut Session, Closed> {
        keep_waker(&mut self.task, cx.waker());
        let session = self.session.as_mut().ok_or(Closed::Eof)?;
        if !session.is_written() {
            session.flush(cx)?;
        }
        Ok(session)
    }

    fn poll_request(&mut self, cx: &mut Context<'_>, malformed: &mut u64) -> Poll<Result<(Bytes, Bytes), Closed>> {
        loop {
            match split(ready!(self.poll_message(cx))?) {
                Some(request) => return Poll::Ready(Ok(request)),
                None => *malformed += 1,
            }
        }
    }

    /// Returns the next message, and handles the commands before it.
    fn poll_message(&mut self, cx: &mut Context<'_>) -> Poll<Result<Message, Closed>> {
        if let Some(message) = self.ahead.take() {
            return Poll::Ready(Ok(message));
        }
        let session = self.prepare(cx)?;
        loop {
            match ready!(session.poll_item(cx))? {
                Item::Message(message) => return Poll::Ready(Ok(message)),
                Item::Command(_) | Item::Ready(_) => {}
            }
        }
    }

    /// Returns true if everything is written.
    fn drive(&mut self, cx: &mut Context<'_>) -> Result<bool, Closed> {
        // Read no further than one request ahead, but far enough to notice that the requester has left.
        if self.ahead.is_none()
            && let Poll::Ready(message) = self.poll_message(cx)
        {
            self.ahead = Some(message?);
        }
        Ok(self.prepare(cx)?.is_written())
    }

    fn reply(&mut self, envelope: &[u8], body: &Bytes) -> Result<(), Closed> {
        let session = self.session.as_mut().ok_or(Closed::Eof)?;
        if session.is_unread(self.in_flight) {
            return Err(ProtocolError::NotReading.into());
        }
        session.write_message(envelope, Header::new(0, body.len()).as_bytes(), body)?;
        self.wake_unless_written();
        Ok(())
    }

    /// Refuses a request. A plain ZeroMQ requester cannot be told.
    fn refuse(&mut self, envelope: &[u8]) {
        let number = bodies(envelope).next().and_then(|frame| <[u8; 8]>::try_from(frame).ok());
        if let (Some(session), Some(number), true) = (&mut self.session, number, self.is_scl)
            && !session.is_unread(self.in_flight)
        {
            // A broken connection is noticed when it is polled next.
            let _written = session.write(&refused(u64::from_be_bytes(number)));
            self.wake_unless_written();
        }
    }

    fn wake_unless_written(&self) {
        if let (Some(session), Some(task)) = (&self.session, &self.task)
            && !session.is_written()
        {
            task.wake_by_ref();
        }
    }
}

impl ReplyPath for Mutex<Exchange> {
    fn refuse(&self, envelope: &Bytes) {
        lock(self).refuse(envelope);
    }

    fn reply(&self, envelope: &Bytes, body: Bytes) -> Result<(), RequesterGone> {
        let mut exchange = lock(self);
        exchange.reply(envelope, &body).map_err(|error| {
            tracing::debug!(%error, "a requester left before it was answered");
            exchange.session = None;
            if let Some(task) = &exchange.task {
                task.wake_by_ref();
            }
            RequesterGone
        })
    }
}

/// Returns envelope and body if the frames in front of the body end with the only empty one.
fn split(Message { envelope, body }: Message) -> Option<(Bytes, Bytes)> {
    let is_delimited = {
        let mut frames = bodies(&envelope);
        frames.by_ref().any(<[u8]>::is_empty) && frames.next().is_none()
    };
    is_delimited.then_some((envelope, body))
}
