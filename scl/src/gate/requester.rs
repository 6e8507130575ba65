//! The `req` gate.

use super::decoder::Decoder;
use super::encoding::Encoding;
use super::exchange::{Exchange, ExchangeError};
use super::stats::GateStats;
use super::watch::Watch;
use super::{AnyGate, exceeded};
use crate::codec::{Codec, DecodeError};
use crate::error::{BlockingError, CallError, GateName, Missing, Peers};
use crate::figures::FigureSource;
use crate::spec::GateSpec;
use crate::state::Owner;
use crate::sync::lock;
use crate::time::Watchdog;
use crate::transport::Requester;
use bytes::Bytes;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::time::Instant;

/// Replaces a timeout whose deadline would overflow: 30 years.
const LONGEST: Duration = Duration::from_secs(30 * 365 * 86_400);

/// Sends requests to the `rep` gate that this gate is connected to.
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
///
/// # Several calls at once
///
/// A clone is a handle to the same gate, for another task or thread. Up to `in_flight` calls of the gate are in
/// progress at once, by default one; the others wait in order, within their timeouts. Each reply is matched with its
/// request, in whatever order the replier answers.
///
/// ```no_run
/// scl::topology!("doc/rover.yaml");
///
/// #[scl::main]
/// async fn main(ui: UserInterface) -> scl::Result<()> {
///     let calls = [0.5, 1.0].map(|target_speed| {
///         let mut commands = ui.commands.clone();
///         tokio::spawn(async move { commands.call(&rover::Command { target_speed }).await })
///     });
///     for call in calls {
///         println!("{}", if call.await??.accepted { "accepted" } else { "refused" });
///     }
///     Ok(())
/// }
/// ```
pub struct Req<A, B> {
    shared: Arc<Shared<A, B>>,
}

struct Shared<A, B> {
    spec: &'static GateSpec,
    name: GateName,
    /// `None` for a gate that is meant to be unconnected.
    exchange: Option<Exchange>,
    encoding: Mutex<Encoding<A>>,
    decoder: Decoder<B>,
    /// Dropped after the end, which belongs to this component only while the component holds its lock.
    state: Owner,
}

impl<A, B> Req<A, B> {
    /// As many calls can be in progress as there are watchdogs.
    pub(crate) fn new<C: Codec<A> + Codec<B>>(
        state: Owner,
        spec: &'static GateSpec,
        link: Option<Box<dyn Requester>>,
        watchdogs: Vec<Watchdog>,
    ) -> Self {
        let name = GateName::new(state.spec.name, spec.name);
        let exchange = link.map(|link| Exchange::new(link, watchdogs, &state));
        let encoding = Mutex::new(Encoding::new::<C>(&state, spec));
        let decoder = Decoder::new::<C>(&state, spec);
        Self { shared: Arc::new(Shared { spec, name, exchange, encoding, decoder, state }) }
    }

    /// Sends a request and waits for the reply, together no longer than the gate's `timeout`.
    ///
    /// That time includes waiting for a replier that is not connected yet or restarts, and for the end of another call
    /// while as many are in progress as the gate's `in_flight` allows.
    ///
    /// # Errors
    /// [`CallError::Timeout`] if no reply arrived in time, [`CallError::PeerLost`] if the replier disconnected after
    /// the request was sent, [`CallError::Refused`] if it could not decode the request. In all cases the next call
    /// starts afresh and never receives the reply to this one. [`CallError::TooLong`] if the replier does not accept a
    /// request of this length; nothing was sent.
    ///
    /// # Cancel safety
    /// Cancel safe. A call that is dropped may still be answered; its reply is discarded.
    pub async fn call(&mut self, request: &A) -> Result<B, CallError> {
        self.call_within(request, self.timeout()).await
    }

    /// [`call`](Self::call) with this timeout instead of the gate's.
    ///
    /// # Errors
    /// Those of `call`. After a timeout, too, the next call never receives the reply to this one.
    ///
    /// # Cancel safety
    /// Same as `call`.
    pub async fn call_within(&mut self, request: &A, timeout: Duration) -> Result<B, CallError> {
        self.exchange(request, timeout).await
    }

    async fn exchange(&self, request: &A, timeout: Duration) -> Result<B, CallError> {
        let Shared { spec, name: gate, exchange, state, .. } = &*self.shared;
        let body = self.encode(request)?;
        let started = Instant::now();
        let deadline = started.checked_add(timeout).unwrap_or_else(|| started + LONGEST);
        let exchanged = match exchange {
            Some(exchange) => exchange.call(body, deadline, state).await,
            None => Exchange::unconnected(deadline, state).await,
        };
        let (gate, peers) = (*gate, Peers::of(spec));
        match exchanged {
            Ok(body) => self.decode(body),
            Err(ExchangeError::Unusable(source)) => Err(CallError::Blocking { gate, source }),
            Err(ExchangeError::Lost) => Err(CallError::PeerLost { gate, peers }),
            Err(ExchangeError::Refused) => Err(CallError::Refused { gate, peers }),
            Err(ExchangeError::TimedOut) => {
                let (connected, waited) = (self.is_connected(), started.elapsed());
                let reason = state.why_missing(spec, &self.missing());
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
        let (state, gate) = (&self.shared.state, self.shared.name);
        state.block_on(self.exchange(request, timeout)).map_err(|source| CallError::Blocking { gate, source })?
    }

    /// Returns the gate's `timeout`.
    pub fn timeout(&self) -> Duration {
        self.shared.spec.options.timeout
    }

    /// Returns true if the replier is connected.
    pub fn is_connected(&self) -> bool {
        self.missing().is_empty()
    }

    /// Returns the gate's counts; `sent` counts requests, `received` replies.
    pub fn stats(&self) -> GateStats {
        self.shared.exchange.as_ref().map(Exchange::stats).unwrap_or_default()
    }

    pub(crate) fn figures(&self) -> FigureSource {
        match &self.shared.exchange {
            Some(exchange) => exchange.figures(),
            None => Box::new(|_| true),
        }
    }

    fn encode(&self, request: &A) -> Result<Bytes, CallError> {
        let Shared { spec, name: gate, encoding, state, .. } = &*self.shared;
        let gate = *gate;
        state.check().map_err(|source: BlockingError| CallError::Blocking { gate, source })?;
        let body = lock(encoding).encode(request).map_err(|source| CallError::Encode { gate, source })?;
        match exceeded(spec.connections.first(), body.len()) {
            Some((peer, size, limit)) => Err(CallError::TooLong { gate, peer, size, limit }),
            None => Ok(body),
        }
    }

    /// Counts a reply that the program itself could not decode, and returns the error of the call.
    pub(crate) fn reject(&self, source: DecodeError) -> CallError {
        self.shared.exchange.iter().for_each(Exchange::count_undecodable);
        CallError::Decode { gate: self.shared.name, peers: Peers::of(self.shared.spec), source }
    }

    fn decode(&self, body: Bytes) -> Result<B, CallError> {
        self.shared.decoder.decode(body).map_err(|source| self.reject(source))
    }

    fn missing(&self) -> Vec<Missing> {
        let Shared { spec, exchange, .. } = &*self.shared;
        exchange.as_ref().map(|exchange| exchange.missing(spec)).unwrap_or_default()
    }
}

/// A clone is a handle to the same gate: both share its connection, its limit of calls in progress and its counts.
impl<A, B> Clone for Req<A, B> {
    fn clone(&self) -> Self {
        Self { shared: Arc::clone(&self.shared) }
    }
}

impl<A, B> super::sealed::Sealed for Req<A, B> {}

impl<A, B> AnyGate for Req<A, B> {
    fn spec(&self) -> &'static GateSpec {
        self.shared.spec
    }

    fn watch(&self) -> Watch {
        match &self.shared.exchange {
            Some(exchange) => exchange.watch(self.shared.spec),
            None => Watch::new(self.shared.spec, Vec::new),
        }
    }
}

impl<A, B> std::fmt::Debug for Req<A, B> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Req").field(&self.shared.spec.name).finish()
    }
}
