//! The `rep` gate.

use super::decoder::Decoder;
use super::encoding::Encoding;
use super::reply_end::{Numbered, ReplyEnd};
use super::stats::GateStats;
use super::tap::{GateTap, ObservedKind};
use super::undecodable::{AT_ONCE, SkipLimit, report, skips, unless_skipped};
use super::watch::Watch;
use super::{AnyGate, ReceivingGate, exceeded};
use crate::codec::{Codec, DecodeError};
use crate::error::{BlockingError, GateName, Peers, RecvError, RecvTimeoutError, ReplyError};
use crate::figures::FigureSource;
use crate::spec::{ConnectionSpec, GateSpec};
use crate::state::Owner;
use crate::sync::lock;
use crate::transport::{IncomingRequest, Replier, ReplyPath};
use bytes::Bytes;
use futures_core::Stream;
use scl_fork::ProcessOwned;
use std::ops::Deref;
use std::pin::Pin;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll};
use std::time::Duration;

/// Answers the requests of any number of `req` gates.
///
/// Each [`Request`] carries its own way back, so requests may be answered later and in any order.
///
/// ```no_run
/// scl::topology!("doc/rover.yaml");
///
/// #[scl::main]
/// async fn main(mut controller: Controller) -> scl::Result<()> {
///     loop {
///         let command = controller.commands.recv().await?;
///         println!("requested {} m/s", command.target_speed);
///         command.reply(&rover::Status { accepted: true })?;
///     }
/// }
/// ```
pub struct Rep<A, B> {
    spec: &'static GateSpec,
    end: ProcessOwned<Arc<ReplyEnd>>,
    decoder: Decoder<A>,
    replies: ProcessOwned<Arc<Replies<B>>>,
}

/// State for sending replies, shared by all requests of a gate.
struct Replies<B> {
    gate: GateName,
    encoding: Mutex<Encoding<B>>,
    tap: GateTap,
    /// The requester that accepts the shortest replies.
    strictest: Option<&'static ConnectionSpec>,
    /// Dropped after the end, which belongs to this component only while the component holds its lock.
    state: Owner,
}

impl<A, B> Rep<A, B> {
    pub(crate) fn new<C: Codec<A> + Codec<B>>(
        state: Owner,
        spec: &'static GateSpec,
        link: Box<dyn Replier>,
        tap: GateTap,
    ) -> Self {
        let gate = GateName::new(state.spec.name, spec.name);
        let decoder = Decoder::new::<C>(&state, spec);
        let end = ReplyEnd::open(link, &state);
        let encoding = Mutex::new(Encoding::new::<C>(&state, spec));
        let strictest = spec.connections.iter().min_by_key(|connection| connection.max_size);
        let replies = Arc::new(Replies { gate, encoding, tap, strictest, state });
        Self { spec, end: ProcessOwned::new(end), decoder, replies: ProcessOwned::new(replies) }
    }

    /// Waits for the next request.
    ///
    /// # Errors
    /// [`RecvError::Decode`] if the codec cannot read a request and the gate declares `undecodable: fail`; by default
    /// it is skipped. Either way the sender's call fails with [`CallError::Refused`](crate::CallError::Refused), except
    /// that of a plain ZeroMQ program, which receives nothing and waits until its own timeout.
    ///
    /// # Cancel safety
    /// Cancel safe: no request is lost if this is dropped before it is ready.
    pub async fn recv(&mut self) -> Result<Request<A, B>, RecvError> {
        self.end.io.call(|cx| self.poll_recv(cx, false)).await
    }

    /// [`recv`](Self::recv) from a plain thread.
    ///
    /// # Errors
    /// Those of `recv`, and [`RecvError::Blocking`] inside async code or after a stop request.
    pub fn recv_blocking(&mut self) -> Result<Request<A, B>, RecvError> {
        let (replies, gate) = (Arc::clone(&self.replies), self.replies.gate);
        replies.state.block_on(self.recv()).map_err(|source| RecvError::Blocking { gate, source })?
    }

    /// [`recv_blocking`](Self::recv_blocking) with a time limit, which is exact to a millisecond.
    ///
    /// # Errors
    /// Those of `recv_blocking`, and [`RecvTimeoutError::Timeout`] if no request arrived in time.
    pub fn recv_timeout(&mut self, timeout: Duration) -> Result<Request<A, B>, RecvTimeoutError> {
        let (replies, gate) = (Arc::clone(&self.replies), self.replies.gate);
        let received = replies.state.block_on_for(timeout, self.recv());
        match received.map_err(|source| RecvError::Blocking { gate, source })? {
            Some(received) => Ok(received?),
            // Any number of requesters may be connected, so none is missing.
            None => Err(RecvTimeoutError::Timeout { gate, peers: Peers::of(self.spec), waited: timeout, reason: None }),
        }
    }

    /// Returns the next request if one has arrived.
    ///
    /// # Errors
    /// Those of `recv`, and [`RecvError::Blocking`] after a stop request.
    pub fn try_recv(&mut self) -> Result<Option<Request<A, B>>, RecvError> {
        self.replies.state.may_proceed().map_err(|source| self.refused(source))?;
        self.replies.state.take_turn();
        let mut limit = SkipLimit::default();
        loop {
            let Some(request) = self.end.try_next() else { return Ok(None) };
            if let Some(decoded) = unless_skipped(self.spec, self.decode(request)) {
                return decoded.map(Some);
            }
            if limit.is_over() {
                return Ok(None);
            }
        }
    }

    /// Returns true if at least one requester is connected.
    pub fn is_connected(&self) -> bool {
        self.end.peers() > 0
    }

    /// Returns the gate's counts; `received` counts requests.
    pub fn stats(&self) -> GateStats {
        GateStats { dropped_for_observers: self.replies.tap.dropped(), ..self.end.stats() }
    }

    pub(crate) fn figures(&self) -> FigureSource {
        self.end.figures(&self.replies.tap)
    }

    fn poll_recv(&self, cx: &mut Context<'_>, may_vanish: bool) -> Poll<Result<Request<A, B>, RecvError>> {
        if let Err(source) = self.replies.state.check() {
            return Poll::Ready(Err(self.refused(source)));
        }
        // After a stop request, calls stay pending until the futures that await them are dropped.
        if self.replies.state.is_stopped() {
            return Poll::Pending;
        }
        for _ in 0..AT_ONCE {
            let Poll::Ready(request) = self.end.poll_next(cx, may_vanish) else { return self.poll_ended().map(Err) };
            if let Some(decoded) = unless_skipped(self.spec, self.decode(request)) {
                return Poll::Ready(decoded);
            }
        }
        cx.waker().wake_by_ref();
        Poll::Pending
    }

    /// Ready if the calls were ended before a call could register its waker.
    fn poll_ended(&self) -> Poll<RecvError> {
        self.replies.state.check().map_or_else(|source| Poll::Ready(self.refused(source)), |()| Poll::Pending)
    }

    fn refused(&self, source: BlockingError) -> RecvError {
        RecvError::Blocking { gate: self.replies.gate, source }
    }

    /// Refuses a request that the program itself could not decode, and reports it.
    pub(crate) fn reject(&mut self, request: Request<A, B>, source: DecodeError) -> Result<(), RecvError> {
        let rejected = Err(self.undecodable(&request.envelope, &*request.path, source));
        if skips(self.spec) { Ok(()) } else { rejected }
    }

    fn decode(&self, (id, IncomingRequest { body, envelope, path }): Numbered) -> Result<Request<A, B>, RecvError> {
        self.replies.tap.observe(ObservedKind::Request, id, &body);
        match self.decoder.decode(body) {
            Ok(message) => Ok(Request { message, id, envelope, path, replies: Arc::clone(&self.replies) }),
            Err(source) => Err(self.undecodable(&envelope, &*path, source)),
        }
    }

    #[cold]
    fn undecodable(&self, envelope: &Bytes, path: &dyn ReplyPath, source: DecodeError) -> RecvError {
        path.refuse(envelope);
        let first = self.end.count_undecodable();
        let error = RecvError::Decode { gate: self.replies.gate, peers: Peers::of(self.spec), source };
        report(self.spec, &error, first);
        error
    }
}

impl<A, B> Drop for Rep<A, B> {
    fn drop(&mut self) {
        if self.replies.state.is_inherited() {
            return;
        }
        self.end.stop_reporting();
        self.replies.state.release(self.end.link());
    }
}

/// A request and its way back to the requester. It can be read like the message that it carries.
///
/// A request that is dropped is not answered: its sender waits until its timeout.
#[must_use = "a request that is not answered keeps its sender waiting until the timeout"]
pub struct Request<A, B> {
    message: A,
    id: u64,
    envelope: Bytes,
    path: Arc<dyn ReplyPath>,
    replies: Arc<Replies<B>>,
}

impl<A, B> Request<A, B> {
    /// Returns the message.
    pub fn message(&self) -> &A {
        &self.message
    }

    /// Sends the reply. It never waits, and may be called from any thread, inside async code or not.
    ///
    /// # Errors
    /// [`ReplyError::RequesterGone`] if the requester has disconnected, which a replier may well ignore;
    /// [`ReplyError::Encode`] if the codec cannot express it; [`ReplyError::TooLong`] if the requester does not accept
    /// a reply of this length.
    pub fn reply(self, reply: &B) -> Result<(), ReplyError> {
        let Replies { gate, encoding, tap, strictest, state } = &*self.replies;
        let gate = *gate;
        state.check().map_err(|source| ReplyError::Blocking { gate, source })?;
        let body = lock(encoding).encode(reply).map_err(|source| ReplyError::Encode { gate, source })?;
        if let Some((peer, size, limit)) = exceeded(*strictest, body.len()) {
            return Err(ReplyError::TooLong { gate, peer, size, limit });
        }
        tap.observe(ObservedKind::Reply, self.id, &body);
        self.path.reply(&self.envelope, body).map_err(|_gone| ReplyError::RequesterGone { gate })
    }
}

impl<A, B> Deref for Request<A, B> {
    type Target = A;

    fn deref(&self) -> &A {
        &self.message
    }
}

impl<A: std::fmt::Debug, B> std::fmt::Debug for Request<A, B> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Request").field(&self.message).finish()
    }
}

impl<A, B> super::sealed::Sealed for Rep<A, B> {}

impl<A, B> AnyGate for Rep<A, B> {
    fn spec(&self) -> &'static GateSpec {
        self.spec
    }

    fn watch(&self) -> Watch {
        Watch::new(self.spec, Vec::new).reporting(self.end.reporter())
    }
}

impl<A, B> ReceivingGate for Rep<A, B> {
    fn poll_ready(&mut self, cx: &mut Context<'_>) -> Poll<Result<(), RecvError>> {
        if let Err(source) = self.replies.state.may_proceed() {
            return Poll::Ready(Err(self.refused(source)));
        }
        match self.end.poll_ready(cx) {
            Poll::Ready(()) => Poll::Ready(Ok(())),
            Poll::Pending => self.poll_ended().map(Err),
        }
    }
}

/// An endless stream of requests.
impl<A, B> Stream for Rep<A, B> {
    type Item = Result<Request<A, B>, RecvError>;

    fn poll_next(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        self.poll_recv(cx, true).map(Some)
    }
}

impl<A, B> std::fmt::Debug for Rep<A, B> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Rep").field(&self.spec.name).finish()
    }
}
