//! The `rep` gate.

use super::encoding::Encoding;
use super::stats::Counts;
use super::{AnyGate, GateName, GateStats, Peers};
use crate::codec::{Codec, DecodeError};
use crate::component::Core;
use crate::error::{RecvError, ReplyError};
use crate::spec::{GateSpec, LinkSpec};
use crate::sync::lock;
use crate::transport::{Answerer, Asked, Responder};
use bytes::Bytes;
use futures_core::Stream;
use std::future::poll_fn;
use std::ops::Deref;
use std::pin::Pin;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};

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
///         println!("asked for {} m/s", command.target_speed);
///         command.reply(&rover::Status { accepted: true }).await?;
///     }
/// }
/// ```
pub struct Rep<A, B> {
    spec: &'static GateSpec,
    name: GateName,
    link: Box<dyn Answerer>,
    /// Shared with the requests, each of which may be answered anywhere.
    encoding: Arc<Mutex<Encoding<B>>>,
    decode: fn(Bytes) -> Result<A, DecodeError>,
    counts: Counts,
    /// Let go after the link, whose endpoint is this component's only as long as it has its name.
    core: Arc<Core>,
}

impl<A, B> Rep<A, B> {
    pub(crate) fn new<C: Codec<A> + Codec<B>>(
        core: Arc<Core>,
        spec: &'static GateSpec,
        link: Box<dyn Answerer>,
    ) -> Self {
        let name = GateName::new(core.spec().name, spec.name);
        let (encoding, decode) = (Arc::new(Mutex::new(Encoding::with::<C>())), <C as Codec<A>>::decode);
        Self { core, spec, name, link, encoding, decode, counts: Counts::default() }
    }

    /// Waits for the next request.
    ///
    /// # Errors
    /// [`RecvError::Decode`] when a request is not what the codec reads; its sender gets no answer, and the next call
    /// goes on with the next request.
    ///
    /// # Cancel safety
    /// Cancel safe: no request is lost when this is dropped before it is ready.
    pub async fn recv(&mut self) -> Result<Request<A, B>, RecvError> {
        poll_fn(|cx| self.poll_recv(cx)).await
    }

    /// [`recv`](Self::recv) from a program without async.
    ///
    /// # Errors
    /// Those of `recv`, and [`RecvError::Blocking`] inside async code, or when the program was told to stop.
    pub fn recv_blocking(&mut self) -> Result<Request<A, B>, RecvError> {
        let core = Arc::clone(&self.core);
        core.block_on(self.recv()).map_err(|source| RecvError::Blocking { gate: self.name, source })?
    }

    /// The next request if one has arrived.
    ///
    /// # Errors
    /// Those of [`recv_blocking`](Self::recv_blocking).
    pub fn try_recv(&mut self) -> Result<Option<Request<A, B>>, RecvError> {
        if self.core.owns_runtime() {
            // Nothing is seen to arrive unless the runtime looks.
            let looked = self.core.block_on(tokio::task::yield_now());
            looked.map_err(|source| RecvError::Blocking { gate: self.name, source })?;
        }
        match self.poll_recv(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(request) => request.map(Some),
            Poll::Pending => Ok(None),
        }
    }

    /// What this gate has done so far; `received` counts requests.
    pub fn stats(&self) -> GateStats {
        let mut stats = GateStats { received: self.counts.messages, ..GateStats::default() };
        self.counts.add_to(&mut stats);
        stats.rejected += self.link.malformed();
        stats
    }

    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Result<Request<A, B>, RecvError>> {
        self.link.poll_asked(cx).map(|Asked { body, responder }| {
            self.counts.moved(body.len());
            match (self.decode)(body) {
                Ok(message) => {
                    let (encoding, core) = (Arc::clone(&self.encoding), Arc::clone(&self.core));
                    Ok(Request { message, way_back: WayBack { responder, encoding, gate: self.name, core } })
                }
                Err(source) => {
                    self.counts.rejected += 1;
                    Err(RecvError::Decode { gate: self.name, peers: Peers(self.spec.links), source })
                }
            }
        })
    }
}

/// A request, which can be read like the message it carries, and its way back.
///
/// A request that is dropped is not answered: its sender waits until its timeout.
#[must_use = "a request that is not answered keeps its sender waiting until the timeout"]
pub struct Request<A, B> {
    message: A,
    way_back: WayBack<B>,
}

struct WayBack<B> {
    responder: Box<dyn Responder>,
    encoding: Arc<Mutex<Encoding<B>>>,
    gate: GateName,
    core: Arc<Core>,
}

impl<A, B> Request<A, B> {
    /// What is asked.
    pub fn message(&self) -> &A {
        &self.message
    }

    /// Answers.
    ///
    /// # Errors
    /// [`ReplyError::RequesterGone`] when nobody waits for the answer any more, which a replier may well ignore;
    /// [`ReplyError::Encode`] when the codec cannot express the answer.
    ///
    /// # Cancel safety
    /// It never waits.
    pub async fn reply(self, answer: &B) -> Result<(), ReplyError> {
        self.reply_now(answer)
    }

    /// [`reply`](Self::reply) from a program without async; it never waits.
    ///
    /// # Errors
    /// Those of `reply`.
    pub fn reply_now(self, answer: &B) -> Result<(), ReplyError> {
        let WayBack { responder, encoding, gate, core } = self.way_back;
        let body = lock(&encoding).encode(answer).map_err(|source| ReplyError::Encode { gate, source })?;
        core.with_a_turn(|| responder.respond(body)).map_err(|_gone| ReplyError::RequesterGone { gate })
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

impl<A, B> AnyGate for Rep<A, B> {
    fn spec(&self) -> &'static GateSpec {
        self.spec
    }

    fn missing(&self) -> Vec<&'static LinkSpec> {
        Vec::new()
    }

    fn core(&self) -> &Arc<Core> {
        &self.core
    }
}

/// All requests, for ever.
impl<A, B> Stream for Rep<A, B> {
    type Item = Result<Request<A, B>, RecvError>;

    fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        (*self).poll_recv(cx).map(Some)
    }
}

impl<A, B> std::fmt::Debug for Rep<A, B> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Rep").field(&self.spec.name).finish()
    }
}
