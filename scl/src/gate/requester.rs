//! The `req` gate.

use super::encoding::Encoding;
use super::stats::Counts;
use super::{AnyGate, GateName, GateStats, Peers};
use crate::codec::{Codec, DecodeError};
use crate::component::Core;
use crate::error::CallError;
use crate::spec::{GateSpec, LinkSpec};
use crate::time::Watchdog;
use crate::transport::{Answer, Asker};
use bytes::Bytes;
use std::future::poll_fn;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

/// Asks the `rep` gate that this gate is connected to, one request at a time.
///
/// ```no_run
/// scl::topology!("doc/rover.yaml");
///
/// #[scl::main]
/// async fn main(mut ui: UserInterface) -> scl::Result<()> {
///     let status = ui.commands.call(&rover::Command { target_speed: 0.5 }).await?;
///     println!("{}", if status.accepted { "accepted" } else { "refused" });
///     Ok(())
/// }
/// ```
pub struct Req<A, B> {
    spec: &'static GateSpec,
    name: GateName,
    /// `None` for a gate that is meant to be unconnected.
    link: Option<Box<dyn Asker>>,
    watchdog: Watchdog,
    encoding: Encoding<A>,
    decode: fn(Bytes) -> Result<B, DecodeError>,
    last_id: u64,
    asked: u64,
    counts: Counts,
    core: Arc<Core>,
}

impl<A, B> Req<A, B> {
    pub(crate) fn new<C: Codec<A> + Codec<B>>(
        core: Arc<Core>,
        spec: &'static GateSpec,
        link: Option<Box<dyn Asker>>,
        watchdog: Watchdog,
    ) -> Self {
        let name = GateName::new(core.spec().name, spec.name);
        let (encoding, decode) = (Encoding::with::<C>(), <C as Codec<B>>::decode);
        Self { core, spec, name, link, watchdog, encoding, decode, last_id: 0, asked: 0, counts: Counts::default() }
    }

    /// Asks, and waits for the answer, together no longer than the gate's `timeout`.
    ///
    /// A replier that is not there yet, or that restarts, is waited for within that time.
    ///
    /// # Errors
    /// [`CallError::Timeout`] when no answer came in time, [`CallError::PeerLost`] when the replier went away after it
    /// was asked; either way the next call starts afresh and never meets an answer to this one.
    ///
    /// # Cancel safety
    /// Cancel safe: a call that is dropped may still be answered, and its answer is then discarded.
    pub async fn call(&mut self, request: &A) -> Result<B, CallError> {
        let encoded = self.encoding.encode(request);
        let body = encoded.map_err(|source| CallError::Encode { gate: self.name, source })?;
        let started = Instant::now();
        let answered = self.exchange(body, started + self.spec.timeout).await;
        answered.unwrap_or_else(|TimedOut| {
            let (connected, waited) = (self.connected(), started.elapsed());
            Err(CallError::Timeout { gate: self.name, peers: Peers(self.spec.links), waited, connected })
        })
    }

    /// [`call`](Self::call) from a program without async.
    ///
    /// # Errors
    /// Those of `call`, and [`CallError::Blocking`] inside async code, or when the program was told to stop.
    pub fn call_blocking(&mut self, request: &A) -> Result<B, CallError> {
        let core = Arc::clone(&self.core);
        core.block_on(self.call(request)).map_err(|source| CallError::Blocking { gate: self.name, source })?
    }

    /// The gate's `timeout`.
    pub fn timeout(&self) -> Duration {
        self.spec.timeout
    }

    /// Whether the replier is connected.
    pub fn connected(&self) -> bool {
        self.missing().is_empty()
    }

    /// What this gate has done so far.
    pub fn stats(&self) -> GateStats {
        let mut stats = GateStats { sent: self.asked, received: self.counts.messages, ..GateStats::default() };
        self.counts.add_to(&mut stats);
        stats.peers = usize::from(self.link.is_some() && self.connected());
        stats
    }

    async fn exchange(&mut self, body: Bytes, deadline: Instant) -> Result<Result<B, CallError>, TimedOut> {
        self.last_id += 1;
        loop {
            self.by(deadline, |link, cx| link.poll_connected(cx)).await?;
            let asked = self.link.as_mut().map(|link| link.ask(self.last_id, body.clone()));
            if !matches!(asked, Some(Err(_refused))) {
                break;
            }
            // The connection broke at this very moment; the next one is on its way.
            tokio::task::yield_now().await;
            if Instant::now() >= deadline {
                return Err(TimedOut);
            }
        }
        self.asked += 1;
        // The library writes in a task of its own: let it, before looking for an answer.
        tokio::task::yield_now().await;
        loop {
            let answer = self.by(deadline, |link, cx| link.poll_answer(cx)).await?;
            let (gate, peers) = (self.name, Peers(self.spec.links));
            match answer {
                Answer::Reply { id, body } if id == self.last_id => {
                    self.counts.moved(body.len());
                    return Ok((self.decode)(body).map_err(|source| {
                        self.counts.rejected += 1;
                        CallError::Decode { gate, peers, source }
                    }));
                }
                Answer::Reply { .. } => tracing::debug!(%gate, "the answer to an earlier call came too late"),
                Answer::Lost => return Ok(Err(CallError::PeerLost { gate, peers })),
            }
        }
    }

    /// Waits for something of the link until the deadline. A gate that is not connected to anything has no link.
    async fn by<R>(
        &mut self,
        deadline: Instant,
        mut poll: impl FnMut(&mut dyn Asker, &mut Context<'_>) -> Poll<R>,
    ) -> Result<R, TimedOut> {
        let (link, watchdog) = (&mut self.link, &mut self.watchdog);
        poll_fn(|cx| {
            if let Some(link) = link
                && let Poll::Ready(ready) = poll(&mut **link, cx)
            {
                return Poll::Ready(Ok(ready));
            }
            // A timer that fails would leave the call waiting for ever.
            watchdog.poll_past(cx, deadline).map(|_past| Err(TimedOut))
        })
        .await
    }
}

struct TimedOut;

impl<A, B> AnyGate for Req<A, B> {
    fn spec(&self) -> &'static GateSpec {
        self.spec
    }

    fn missing(&self) -> Vec<&'static LinkSpec> {
        let connected = self.link.as_ref().is_none_or(|link| link.is_connected());
        self.spec.links.iter().filter(|link| link.required && !connected).collect()
    }

    fn core(&self) -> &Arc<Core> {
        &self.core
    }
}

impl<A, B> std::fmt::Debug for Req<A, B> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Req").field(&self.spec.name).finish()
    }
}
