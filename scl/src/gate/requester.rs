//! The `req` gate.

use super::AnyGate;
use super::encoding::Encoding;
use super::exchange::{Exchange, ExchangeError};
use super::stats::GateStats;
use super::watch::Watch;
use crate::codec::{Codec, DecodeError};
use crate::error::{BlockingError, CallError, GateName, Missing, PeerName, Peers};
use crate::figures::FigureSource;
use crate::spec::GateSpec;
use crate::state::Owner;
use crate::time::Watchdog;
use crate::transport::Requester;
use bytes::Bytes;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::Instant;

/// A timeout that never ends: 30 years.
const LONGEST: Duration = Duration::from_secs(30 * 365 * 86_400);

/// Sends requests to the `rep` gate that this gate is connected to, one at a time.
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
    exchange: Option<Exchange>,
    watchdog: Watchdog,
    encoding: Encoding<A>,
    decode: fn(Bytes) -> Result<B, DecodeError>,
    last_id: u64,
    /// Dropped after the end, which is this component's only as long as it holds its lock.
    state: Owner,
}

impl<A, B> Req<A, B> {
    pub(crate) fn new<C: Codec<A> + Codec<B>>(
        state: Owner,
        spec: &'static GateSpec,
        link: Option<Box<dyn Requester>>,
        watchdog: Watchdog,
    ) -> Self {
        let name = GateName::new(state.spec().name, spec.name);
        let exchange = link.map(|link| Exchange::new(link, &state));
        Self {
            spec,
            name,
            exchange,
            watchdog,
            encoding: Encoding::with::<C>(),
            decode: <C as Codec<B>>::decode,
            last_id: 0,
            state,
        }
    }

    /// Sends a request and waits for the reply, together no longer than the gate's `timeout`.
    ///
    /// A replier that is not connected yet, or that restarts, is waited for within that time.
    ///
    /// # Errors
    /// [`CallError::Timeout`] if no reply arrived in time, [`CallError::PeerLost`] if the replier disconnected after the
    /// request was sent. Either way the next call starts afresh and never receives the reply to this one.
    /// [`CallError::TooLong`] if the replier does not accept a request of this length; nothing was sent.
    ///
    /// # Cancel safety
    /// Cancel safe. A call that is dropped may still be answered; its reply is discarded.
    pub async fn call(&mut self, request: &A) -> Result<B, CallError> {
        self.call_within(request, self.timeout()).await
    }

    /// [`call`](Self::call) with a timeout of its own instead of the gate's.
    ///
    /// # Errors
    /// Those of `call`. After a timeout, too, the next call never receives the reply to this one.
    ///
    /// # Cancel safety
    /// As `call`.
    pub async fn call_within(&mut self, request: &A, timeout: Duration) -> Result<B, CallError> {
        let body = self.encode(request)?;
        let started = Instant::now();
        self.last_id += 1;
        let deadline = started.checked_add(timeout).unwrap_or_else(|| started + LONGEST);
        let exchanged = match &self.exchange {
            Some(exchange) => exchange.call(self.last_id, body, &mut self.watchdog, deadline, &self.state).await,
            None => Exchange::unconnected(&mut self.watchdog, deadline, &self.state).await,
        };
        let (gate, peers) = (self.name, Peers::of(self.spec));
        match exchanged {
            Ok(body) => self.decode(body),
            Err(ExchangeError::Refused(source)) => Err(CallError::Blocking { gate, source }),
            Err(ExchangeError::Lost) => Err(CallError::PeerLost { gate, peers }),
            Err(ExchangeError::TimedOut) => {
                let (connected, waited) = (self.is_connected(), started.elapsed());
                let reason = self.state.why_missing(self.spec, &self.missing());
                Err(CallError::Timeout { gate, peers, waited, connected, reason })
            }
        }
    }

    /// [`call`](Self::call) from a plain thread.
    ///
    /// # Errors
    /// Those of `call`, and [`CallError::Blocking`] inside async code or after a stop request.
    pub fn call_blocking(&mut self, request: &A) -> Result<B, CallError> {
        self.call_timeout(request, self.timeout())
    }

    /// [`call_within`](Self::call_within) from a plain thread.
    ///
    /// # Errors
    /// Those of `call_blocking`.
    pub fn call_timeout(&mut self, request: &A, timeout: Duration) -> Result<B, CallError> {
        let (state, gate) = (Arc::clone(&self.state), self.name);
        state.block_on(self.call_within(request, timeout)).map_err(|source| CallError::Blocking { gate, source })?
    }

    /// The gate's `timeout`.
    pub fn timeout(&self) -> Duration {
        self.spec.options.timeout
    }

    /// Returns true if the replier is connected.
    pub fn is_connected(&self) -> bool {
        self.missing().is_empty()
    }

    /// Returns the gate's counts; `sent` counts requests, `received` replies.
    pub fn stats(&self) -> GateStats {
        self.exchange.as_ref().map(Exchange::stats).unwrap_or_default()
    }

    pub(crate) fn figures(&self) -> FigureSource {
        match &self.exchange {
            Some(exchange) => exchange.figures(),
            None => Box::new(|_| true),
        }
    }

    fn encode(&mut self, request: &A) -> Result<Bytes, CallError> {
        let gate = self.name;
        self.state.check().map_err(|source: BlockingError| CallError::Blocking { gate, source })?;
        let body = self.encoding.encode(request).map_err(|source| CallError::Encode { gate, source })?;
        match self.spec.links.first() {
            Some(link) if body.len() as u64 > link.max_size => Err(CallError::TooLong {
                gate,
                peer: PeerName::of(link),
                size: body.len() as u64,
                limit: link.max_size,
            }),
            _ => Ok(body),
        }
    }

    /// Counts a reply that the program itself could not decode.
    pub(crate) fn reject(&mut self, source: DecodeError) -> CallError {
        self.exchange.iter().for_each(Exchange::count_undecodable);
        CallError::Decode { gate: self.name, peers: Peers::of(self.spec), source }
    }

    fn decode(&mut self, body: Bytes) -> Result<B, CallError> {
        (self.decode)(body).map_err(|source| {
            self.exchange.iter().for_each(Exchange::count_undecodable);
            CallError::Decode { gate: self.name, peers: Peers::of(self.spec), source }
        })
    }

    fn missing(&self) -> Vec<Missing> {
        self.exchange.as_ref().map(|exchange| exchange.missing(self.spec)).unwrap_or_default()
    }
}

impl<A, B> Drop for Req<A, B> {
    fn drop(&mut self) {
        if self.state.is_inherited() {
            self.exchange.iter().for_each(Exchange::leak);
        }
    }
}

impl<A, B> super::sealed::Sealed for Req<A, B> {}

impl<A, B> AnyGate for Req<A, B> {
    fn spec(&self) -> &'static GateSpec {
        self.spec
    }

    fn missing(&self) -> Vec<Missing> {
        self.missing()
    }

    fn watch(&self) -> Watch {
        match &self.exchange {
            Some(exchange) => exchange.watch(self.spec),
            None => Watch::new(self.spec, Vec::new),
        }
    }
}

impl<A, B> std::fmt::Debug for Req<A, B> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Req").field(&self.spec.name).finish()
    }
}
