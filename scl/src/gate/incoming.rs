//! What `sub` and `pull` share: receiving and decoding.

use super::inbox::{Arrived, SharedInbox};
use super::stats::GateStats;
use super::tap::GateTap;
#[cfg(feature = "raw")]
use super::view::View;
use super::watch::Watch;
#[cfg(feature = "raw")]
use crate::codec::Raw;
use crate::codec::{Codec, DecodeError};
use crate::error::{BlockingError, GateName, Missing, Peers, RecvError, RecvTimeoutError};
use crate::figures::FigureSource;
use crate::spec::GateSpec;
use crate::state::Owner;
use crate::sync::lock;
use crate::transport::Receiver;
use bytes::Bytes;
#[cfg(feature = "raw")]
use std::any::TypeId;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};
#[cfg(feature = "raw")]
use zerocopy::{FromBytes, Immutable, KnownLayout};

pub(crate) struct Incoming<T> {
    pub(crate) spec: &'static GateSpec,
    name: GateName,
    inbox: SharedInbox,
    decode: fn(Bytes) -> Result<T, DecodeError>,
    #[cfg(feature = "raw")]
    codec: TypeId,
    /// Dropped after the ends, which are this component's only as long as it holds its lock.
    pub(crate) state: Owner,
}

impl<T> Incoming<T> {
    pub(crate) fn new<C: Codec<T>>(
        state: Owner,
        spec: &'static GateSpec,
        links: Vec<Box<dyn Receiver>>,
        tap: GateTap,
    ) -> Self {
        let name = GateName::new(state.spec().name, spec.name);
        let inbox = SharedInbox::new(spec, links, tap, &state);
        Self {
            spec,
            name,
            inbox,
            decode: C::decode,
            #[cfg(feature = "raw")]
            codec: TypeId::of::<C>(),
            state,
        }
    }

    pub(crate) async fn recv(&mut self) -> Result<T, RecvError> {
        let arrived = Recv { gate: self, is_waiting: false }.await?;
        self.decode(arrived)
    }

    pub(crate) fn recv_blocking(&mut self) -> Result<T, RecvError> {
        let arrived = self.next_blocking()?;
        self.decode(arrived)
    }

    fn next_blocking(&mut self) -> Result<Arrived, RecvError> {
        let (state, gate) = (Arc::clone(&self.state), self.name);
        let blocking = |source| RecvError::Blocking { gate, source };
        state.may_block().map_err(blocking)?;
        if let Some(arrived) = self.wait_directly(Duration::MAX) {
            return Ok(arrived);
        }
        state.block_on(Recv { gate: self, is_waiting: false }).map_err(blocking)?
    }

    pub(crate) fn recv_timeout(&mut self, timeout: Duration) -> Result<T, RecvTimeoutError> {
        let (state, gate) = (Arc::clone(&self.state), self.name);
        let blocking = |source| RecvTimeoutError::Recv(RecvError::Blocking { gate, source });
        state.may_block().map_err(blocking)?;
        let started = Instant::now();
        if let Some(arrived) = self.wait_directly(timeout) {
            return Ok(self.decode(arrived)?);
        }
        let left = timeout.saturating_sub(started.elapsed());
        match state.block_on_for(left, self.recv()).map_err(blocking)? {
            Some(received) => Ok(received?),
            None => {
                let (peers, reason) = (Peers::of(self.spec), self.state.why_missing(self.spec, &self.missing()));
                Err(RecvTimeoutError::Timeout { gate, peers, waited: timeout, reason })
            }
        }
    }

    /// Waits for a message on the calling thread, without the runtime, where that is possible: for a short time, and no
    /// longer than `limit`.
    fn wait_directly(&self, limit: Duration) -> Option<Arrived> {
        let within = self.state.direct_wait()?.min(limit);
        let arrived = self.inbox.lock().wait(within)?;
        self.state.take_turn();
        Some(arrived)
    }

    /// The next item of a stream, which may be dropped without notice.
    pub(crate) fn poll_next(&mut self, cx: &mut Context<'_>) -> Poll<Result<T, RecvError>> {
        self.poll_arrived(cx, true).map(|arrived| self.decode(arrived?))
    }

    fn poll_arrived(&mut self, cx: &mut Context<'_>, may_vanish: bool) -> Poll<Result<Arrived, RecvError>> {
        if let Err(source) = self.state.check() {
            return Poll::Ready(Err(self.refused(source)));
        }
        // A stopped program's calls stay pending: what waits for them is dropped.
        if self.state.is_stopped() {
            return Poll::Pending;
        }
        match self.inbox.poll_next(cx, may_vanish) {
            Poll::Ready(arrived) => Poll::Ready(Ok(arrived)),
            Poll::Pending => self.poll_ended().map(Err),
        }
    }

    /// Ready if the calls were ended before a call could register its waker.
    fn poll_ended(&self) -> Poll<RecvError> {
        self.state.check().map_or_else(|source| Poll::Ready(self.refused(source)), |()| Poll::Pending)
    }

    /// Ready when a message can be taken, or a call would fail. It takes none.
    pub(crate) fn poll_ready(&mut self, cx: &mut Context<'_>) -> Poll<Result<(), RecvError>> {
        if let Err(source) = self.state.may_proceed() {
            return Poll::Ready(Err(self.refused(source)));
        }
        match self.inbox.poll_ready(cx) {
            Poll::Ready(()) => Poll::Ready(Ok(())),
            Poll::Pending => self.poll_ended().map(Err),
        }
    }

    pub(crate) fn try_recv(&mut self) -> Result<Option<T>, RecvError> {
        self.look(|inbox| inbox.lock().try_next())?.map(|arrived| self.decode(arrived)).transpose()
    }

    pub(crate) fn latest(&mut self) -> Result<Option<T>, RecvError> {
        self.look(|inbox| inbox.lock().newest())?.map(|arrived| self.decode(arrived)).transpose()
    }

    fn look(&mut self, look: impl FnOnce(&SharedInbox) -> Option<Arrived>) -> Result<Option<Arrived>, RecvError> {
        self.state.may_proceed().map_err(|source| self.refused(source))?;
        self.state.take_turn();
        Ok(look(&self.inbox))
    }

    #[cfg(feature = "raw")]
    pub(crate) async fn recv_view(&mut self) -> Result<View<T>, RecvError>
    where
        T: FromBytes + KnownLayout + Immutable,
    {
        self.check_views()?;
        let arrived = Recv { gate: self, is_waiting: false }.await?;
        self.view(arrived)
    }

    #[cfg(feature = "raw")]
    pub(crate) fn recv_view_blocking(&mut self) -> Result<View<T>, RecvError>
    where
        T: FromBytes + KnownLayout + Immutable,
    {
        self.check_views()?;
        let arrived = self.next_blocking()?;
        self.view(arrived)
    }

    #[cfg(feature = "raw")]
    pub(crate) fn try_recv_view(&mut self) -> Result<Option<View<T>>, RecvError>
    where
        T: FromBytes + KnownLayout + Immutable,
    {
        self.check_views()?;
        self.look(|inbox| inbox.lock().try_next())?.map(|arrived| self.view(arrived)).transpose()
    }

    /// Fails before a message is taken.
    #[cfg(feature = "raw")]
    fn check_views(&self) -> Result<(), RecvError> {
        if self.codec == TypeId::of::<Raw>() {
            return Ok(());
        }
        Err(RecvError::NoViews { gate: self.name, codec: self.spec.codec })
    }

    #[cfg(feature = "raw")]
    fn view(&mut self, Arrived { link, frame }: Arrived) -> Result<View<T>, RecvError>
    where
        T: FromBytes + KnownLayout + Immutable,
    {
        let received = frame.len();
        View::new(frame).ok_or_else(|| self.undecodable(link, Raw::wrong_length::<T>(received)))
    }

    fn refused(&self, source: BlockingError) -> RecvError {
        RecvError::Blocking { gate: self.name, source }
    }

    fn decode(&mut self, Arrived { link, frame }: Arrived) -> Result<T, RecvError> {
        (self.decode)(frame).map_err(|source| self.undecodable(link, source))
    }

    fn undecodable(&self, link: usize, source: DecodeError) -> RecvError {
        self.inbox.lock().undecodable += 1;
        RecvError::Decode { gate: self.name, peers: self.senders(link), source }
    }

    /// Counts a message that the program itself could not decode.
    pub(crate) fn reject(&mut self, source: DecodeError) -> RecvError {
        self.inbox.lock().undecodable += 1;
        RecvError::Decode { gate: self.name, peers: Peers::of(self.spec), source }
    }

    /// The possible senders of a message: a listening gate has one link for all its peers.
    fn senders(&self, link: usize) -> Peers {
        let links = self.spec.links;
        if self.spec.endpoint.is_empty() { Peers(&links[link..=link]) } else { Peers(links) }
    }

    /// Returns true if all required peers are connected, or, for a listening gate, at least one peer.
    pub(crate) fn is_connected(&self) -> bool {
        match self.spec.endpoint {
            "" => self.missing().is_empty(),
            _ => self.inbox.lock().peers() > 0,
        }
    }

    pub(crate) fn missing(&self) -> Vec<Missing> {
        if !self.spec.endpoint.is_empty() {
            return Vec::new();
        }
        self.inbox.lock().missing(self.spec)
    }

    pub(crate) fn watch(&self) -> Watch {
        let (spec, inbox, reporting) = (self.spec, self.inbox.downgrade(), self.inbox.downgrade());
        let watch = Watch::new(spec, move || match inbox.upgrade().filter(|_| spec.endpoint.is_empty()) {
            Some(inbox) => lock(&inbox).missing(spec),
            None => Vec::new(),
        });
        watch
            .reporting(move |set| reporting.upgrade().into_iter().for_each(|inbox| lock(&inbox).report_to(set.clone())))
    }

    pub(crate) fn figures(&self) -> FigureSource {
        self.inbox.figures()
    }

    pub(crate) fn stats(&self) -> GateStats {
        let inbox = self.inbox.lock();
        let mut stats = GateStats {
            received: inbox.received,
            rejected: inbox.rejected(),
            dropped_oldest: inbox.queue().dropped_oldest,
            dropped_newest: inbox.queue().dropped_newest,
            dropped_for_observers: inbox.tap_dropped(),
            waiting: inbox.queue().len(),
            peers: inbox.peers(),
            ..GateStats::default()
        };
        inbox.activity.add_to(&mut stats);
        stats
    }
}

impl<T> Drop for Incoming<T> {
    fn drop(&mut self) {
        if self.state.is_inherited() {
            return self.inbox.leak();
        }
        // The task may hold the inbox a little longer.
        self.inbox.lock().stop_reporting();
    }
}

/// A receiving call. Dropping it before it is ready hands the gate's I/O back to the background task.
struct Recv<'a, T> {
    gate: &'a mut Incoming<T>,
    is_waiting: bool,
}

impl<T> Future for Recv<'_, T> {
    type Output = Result<Arrived, RecvError>;

    fn poll(mut self: std::pin::Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Self::Output> {
        let polled = self.gate.poll_arrived(cx, false);
        self.is_waiting = polled.is_pending();
        polled
    }
}

impl<T> Drop for Recv<'_, T> {
    fn drop(&mut self) {
        if self.is_waiting {
            self.gate.inbox.io.cancel();
        }
    }
}
