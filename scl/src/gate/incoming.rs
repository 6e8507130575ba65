//! What `sub` and `pull` share: receiving and decoding.

use super::catch_up::Caller;
use super::decoder::Decoder;
use super::inbox::{SharedInbox, Untold};
use super::links::Arrived;
use super::missed;
use super::stats::GateStats;
use super::tap::GateTap;
use super::undecodable::{AT_ONCE, SkipLimit, report, skips, unless_skipped};
#[cfg(feature = "raw")]
use super::view::View;
use super::watch::Watch;
#[cfg(feature = "raw")]
use crate::codec::Raw;
use crate::codec::{Codec, DecodeError};
use crate::error::{BlockingError, GateName, Missing, Peers, RecvError, RecvTimeoutError};
use crate::figures::FigureSource;
use crate::spec::{ConnectionSpec, GateSpec};
use crate::state::Owner;
use crate::sync::lock;
use crate::transport::Receiver;
#[cfg(feature = "raw")]
use std::any::TypeId;
use std::collections::VecDeque;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::{Duration, Instant};
#[cfg(feature = "raw")]
use zerocopy::{FromBytes, Immutable, KnownLayout};

pub(crate) struct Incoming<T> {
    pub(crate) spec: &'static GateSpec,
    name: GateName,
    inbox: SharedInbox,
    decoder: Decoder<T>,
    /// The link of the last message; `None` before the first one.
    last: Option<usize>,
    /// Reused memory, empty between calls, for the messages from which `latest` chooses.
    arrived: VecDeque<Arrived>,
    /// When the message given to the program last was sent, if that was before this gate had joined.
    latched: Option<Instant>,
    #[cfg(feature = "raw")]
    codec: TypeId,
    /// Dropped last: the ends belong to this component only as long as it holds its lock.
    pub(crate) state: Owner,
}

impl<T> Incoming<T> {
    pub(crate) fn new<C: Codec<T>>(
        state: Owner,
        spec: &'static GateSpec,
        links: Vec<Box<dyn Receiver>>,
        tap: GateTap,
    ) -> Self {
        let name = GateName::new(state.spec.name, spec.name);
        let inbox = SharedInbox::new(spec, links, tap, &state);
        Self {
            spec,
            name,
            inbox,
            decoder: Decoder::new::<C>(&state, spec),
            last: None,
            arrived: VecDeque::new(),
            latched: None,
            #[cfg(feature = "raw")]
            codec: TypeId::of::<C>(),
            state,
        }
    }

    pub(crate) fn recv(&mut self) -> impl Future<Output = Result<T, RecvError>> {
        self.next(Caller::NewCall, Self::decode)
    }

    pub(crate) fn recv_blocking(&mut self) -> Result<T, RecvError> {
        self.next_blocking(Self::decode)
    }

    /// Waits for the next message that can be decoded. It is decoded here and not in `IoWaker::call`, because a long
    /// message would be moved, and take room on the stack, once more.
    async fn next<R>(&mut self, mut caller: Caller, decode: impl Decode<T, R>) -> Result<R, RecvError> {
        loop {
            for _ in 0..AT_ONCE {
                let polled =
                    |cx: &mut Context<'_>| self.poll_arrived(cx, std::mem::replace(&mut caller, Caller::SameCall));
                let arrived = self.inbox.io.call(polled).await;
                let Some(arrived) = arrived else { return self.refuse() };
                caller = Caller::NewCall;
                if let Some(decoded) = self.usable(arrived, &decode) {
                    return decoded;
                }
            }
            tokio::task::yield_now().await;
        }
    }

    fn next_blocking<R>(&mut self, decode: impl Decode<T, R>) -> Result<R, RecvError> {
        let (state, gate) = (Arc::clone(&self.state), self.name);
        let blocking = |source| RecvError::Blocking { gate, source };
        state.may_block().map_err(blocking)?;
        let caller = match self.wait_directly(Duration::MAX) {
            Err(caller) => caller,
            Ok(arrived) => match self.usable(arrived, &decode) {
                Some(decoded) => return decoded,
                None => Caller::NewCall,
            },
        };
        state.block_on(self.next(caller, decode)).map_err(blocking)?
    }

    pub(crate) fn recv_timeout(&mut self, timeout: Duration) -> Result<T, RecvTimeoutError> {
        let (state, gate) = (Arc::clone(&self.state), self.name);
        let blocking = |source| RecvTimeoutError::Recv(RecvError::Blocking { gate, source });
        state.may_block().map_err(blocking)?;
        let started = Instant::now();
        let caller = match self.wait_directly(timeout) {
            Err(caller) => caller,
            Ok(arrived) => match self.usable(arrived, Self::decode) {
                Some(decoded) => return Ok(decoded?),
                None => Caller::NewCall,
            },
        };
        let left = timeout.saturating_sub(started.elapsed());
        match state.block_on_for(left, self.next(caller, Self::decode)).map_err(blocking)? {
            Some(received) => Ok(received?),
            None => {
                let (peers, reason) = (Peers::of(self.spec), self.state.why_missing(self.spec, &self.missing()));
                Err(RecvTimeoutError::Timeout { gate, peers, waited: timeout, reason })
            }
        }
    }

    /// Waits for a message on the calling thread, without the runtime, where that is possible: for a short time, and no
    /// longer than `limit`. If nothing has arrived, returns the [`Caller`] to continue with.
    fn wait_directly(&self, limit: Duration) -> Result<Arrived, Caller> {
        let within = self.state.direct_wait().ok_or(Caller::NewCall)?.min(limit);
        let arrived = self.inbox.lock().wait(within).ok_or(Caller::SameCall)?;
        self.state.take_turn();
        Ok(arrived)
    }

    /// Polls for the next item of a stream, which may be dropped without notice.
    pub(crate) fn poll_next(&mut self, cx: &mut Context<'_>) -> Poll<Result<T, RecvError>> {
        for _ in 0..AT_ONCE {
            let Some(arrived) = ready!(self.poll_arrived(cx, Caller::Stream)) else {
                return Poll::Ready(self.refuse());
            };
            if let Some(decoded) = self.usable(arrived, Self::decode) {
                return Poll::Ready(decoded);
            }
        }
        cx.waker().wake_by_ref();
        Poll::Pending
    }

    /// Returns `None` if the call must fail with the error of [`refuse`](Self::refuse). An error in its place would
    /// share memory with the message, and the compiler would move the message in pieces: for a short message, that
    /// takes a noticeable part of the time.
    fn poll_arrived(&self, cx: &mut Context<'_>, caller: Caller) -> Poll<Option<Arrived>> {
        if self.state.check().is_err() {
            return Poll::Ready(None);
        }
        // After a stop request, calls stay pending until the futures that await them are dropped.
        if self.state.is_stopped() {
            return Poll::Pending;
        }
        match self.inbox.poll_next(cx, caller) {
            Poll::Ready(arrived) => Poll::Ready(Some(arrived)),
            // `end_calls` may have run before this call registered its waker.
            Poll::Pending if self.state.check().is_err() => Poll::Ready(None),
            Poll::Pending => Poll::Pending,
        }
    }

    /// Returns the error of a call that the component's state does not allow, now or ever again.
    #[cold]
    fn refuse<R>(&self) -> Result<R, RecvError> {
        Err(self.refused(self.state.check().err().unwrap_or(BlockingError::Closed)))
    }

    /// Ready when a message can be taken, or a call would fail. It takes none.
    pub(crate) fn poll_ready(&mut self, cx: &mut Context<'_>) -> Poll<Result<(), RecvError>> {
        if let Err(source) = self.state.may_proceed() {
            return Poll::Ready(Err(self.refused(source)));
        }
        match self.inbox.poll_ready(cx) {
            Poll::Ready(()) => Poll::Ready(Ok(())),
            Poll::Pending if self.state.check().is_err() => Poll::Ready(self.refuse()),
            Poll::Pending => Poll::Pending,
        }
    }

    pub(crate) fn try_recv(&mut self) -> Result<Option<T>, RecvError> {
        self.try_next(Self::decode)
    }

    fn try_next<R>(&mut self, decode: impl Decode<T, R>) -> Result<Option<R>, RecvError> {
        self.take_turn()?;
        let mut limit = SkipLimit::default();
        loop {
            let Some(arrived) = self.inbox.lock().try_next() else { return Ok(None) };
            if let Some(decoded) = self.usable(arrived, &decode) {
                return decoded.map(Some);
            }
            if limit.is_over() {
                return Ok(None);
            }
        }
    }

    pub(crate) fn latest(&mut self) -> Result<Option<T>, RecvError> {
        self.take_turn()?;
        let mut arrived = std::mem::take(&mut self.arrived);
        self.inbox.lock().take_all(&mut arrived);
        let newest = self.newest_of(&mut arrived);
        arrived.clear();
        self.arrived = arrived;
        newest
    }

    fn newest_of(&mut self, arrived: &mut VecDeque<Arrived>) -> Result<Option<T>, RecvError> {
        while let Some(newest) = arrived.pop_back() {
            if let Some(decoded) = self.usable(newest, Self::decode) {
                return decoded.map(Some);
            }
        }
        Ok(None)
    }

    /// Decodes a message; `None` for one that the program does not get, because it is too old or cannot be read.
    // A call would move each message twice more, for `max_age`, which few gates have.
    #[inline(always)]
    fn usable<R>(&mut self, arrived: Arrived, decode: impl Decode<T, R>) -> Option<Result<R, RecvError>> {
        if let (Some(most), Some(sent)) = (self.spec.options.max_age, arrived.sent)
            && sent.elapsed() > most
        {
            self.inbox.lock().links.count_expired(arrived.link);
            return None;
        }
        unless_skipped(self.spec, decode(self, arrived))
    }

    fn take_turn(&mut self) -> Result<(), RecvError> {
        self.state.may_proceed().map_err(|source| self.refused(source))?;
        self.state.take_turn();
        Ok(())
    }

    fn refused(&self, source: BlockingError) -> RecvError {
        RecvError::Blocking { gate: self.name, source }
    }

    fn decode(&mut self, Arrived { link, frame, sent, is_latched }: Arrived) -> Result<T, RecvError> {
        (self.last, self.latched) = (Some(link), sent.filter(|_| is_latched));
        self.decoder.decode(frame).map_err(|source| self.undecodable(link, source))
    }

    #[cold]
    fn undecodable(&self, link: usize, source: DecodeError) -> RecvError {
        let first = self.inbox.lock().undecodable.add(link);
        let error = RecvError::Decode { gate: self.name, peers: self.senders(link), source };
        report(self.spec, &error, first);
        error
    }

    /// Reports the last message, which the program itself could not decode.
    pub(crate) fn reject(&mut self, source: DecodeError) -> Result<(), RecvError> {
        let rejected = Err(self.undecodable(self.last.unwrap_or_default(), source));
        if skips(self.spec) { Ok(()) } else { rejected }
    }

    /// The possible senders of a message: a listening gate has one link for all its peers.
    fn senders(&self, link: usize) -> Peers {
        let links = self.spec.connections;
        if self.spec.endpoint.is_empty() { Peers(&links[link..=link]) } else { Peers(links) }
    }

    /// The connection of the message given to the program last, of a gate with one link per peer.
    pub(crate) fn last_connection(&self) -> Option<&'static ConnectionSpec> {
        self.spec.connections.get(self.last?)
    }

    /// The index of that connection, after a message was received.
    pub(crate) fn last_link(&self) -> usize {
        debug_assert!(self.last.is_some(), "no message was received");
        self.last.unwrap_or_default()
    }

    /// The age of the message given to the program last, if its publisher had sent it before this gate joined.
    pub(crate) fn latched_age(&self) -> Option<Duration> {
        self.latched.map(|sent| sent.elapsed())
    }

    /// Returns true if all required peers are connected, or, for a listening gate, at least one peer.
    pub(crate) fn is_connected(&self) -> bool {
        match self.spec.endpoint {
            "" => self.missing().is_empty(),
            _ => self.inbox.lock().links.peers() > 0,
        }
    }

    pub(crate) fn missing(&self) -> Vec<Missing> {
        if !self.spec.endpoint.is_empty() {
            return Vec::new();
        }
        self.inbox.lock().links.missing(self.spec)
    }

    pub(crate) fn watch(&self) -> Watch {
        let (spec, inbox, reporting) = (self.spec, self.inbox.downgrade(), self.inbox.downgrade());
        let watch = Watch::new(spec, move || match inbox.upgrade().filter(|_| spec.endpoint.is_empty()) {
            Some(inbox) => lock(&inbox).links.missing(spec),
            None => Vec::new(),
        });
        watch
            .reporting(move |set| reporting.upgrade().into_iter().for_each(|inbox| lock(&inbox).report_to(set.clone())))
    }

    /// Waits until messages did not come within the gate's deadline, and returns how many. It borrows nothing of the
    /// gate, and does not keep it open.
    pub(crate) fn deadline_missed(&self) -> impl Future<Output = Result<u64, RecvError>> + Send + use<T> {
        let waits = self.may_miss().map(|()| missed::wait(self.name, &self.state, self.inbox.downgrade()));
        async { waits?.await }
    }

    /// Returns how many messages did not come within the gate's deadline, of which the program was not told yet.
    pub(crate) fn take_missed(&mut self) -> Result<u64, RecvError> {
        self.may_miss()?;
        self.take_turn()?;
        match self.inbox.lock().tell_missed() {
            Untold::Missed(untold) => Ok(untold.get()),
            Untold::NoneBefore(_) => Ok(0),
        }
    }

    /// Fails if no message is ever missed.
    fn may_miss(&self) -> Result<(), RecvError> {
        if self.spec.options.deadline.is_some() { Ok(()) } else { Err(RecvError::NoDeadline { gate: self.name }) }
    }

    pub(crate) fn figures(&self) -> FigureSource {
        self.inbox.figures()
    }

    pub(crate) fn stats(&self) -> GateStats {
        GateStats::of(|figures| self.inbox.lock().read_figures(figures))
    }
}

#[cfg(feature = "raw")]
impl<T: FromBytes + KnownLayout + Immutable> Incoming<T> {
    pub(crate) async fn recv_view(&mut self) -> Result<View<T>, RecvError> {
        self.check_views()?;
        self.next(Caller::NewCall, Self::view).await
    }

    pub(crate) fn recv_view_blocking(&mut self) -> Result<View<T>, RecvError> {
        self.check_views()?;
        self.next_blocking(Self::view)
    }

    pub(crate) fn try_recv_view(&mut self) -> Result<Option<View<T>>, RecvError> {
        self.check_views()?;
        self.try_next(Self::view)
    }

    /// Fails, before a message is taken, if the gate's codec is not `raw`.
    fn check_views(&self) -> Result<(), RecvError> {
        if self.codec == TypeId::of::<Raw>() {
            return Ok(());
        }
        Err(RecvError::NoViews { gate: self.name, codec: self.spec.codec })
    }

    fn view(&mut self, Arrived { link, frame, sent, is_latched }: Arrived) -> Result<View<T>, RecvError> {
        (self.last, self.latched) = (Some(link), sent.filter(|_| is_latched));
        let received = frame.len();
        View::new(frame).ok_or_else(|| self.undecodable(link, Raw::wrong_length::<T>(received)))
    }
}

impl<T> Drop for Incoming<T> {
    fn drop(&mut self) {
        if self.state.is_inherited() {
            return;
        }
        // The task may keep the inbox alive a little longer, so stop its reports now.
        self.inbox.lock().stop_reporting();
    }
}

/// Decodes what has arrived.
trait Decode<T, R>: Fn(&mut Incoming<T>, Arrived) -> Result<R, RecvError> {}

impl<T, R, D: Fn(&mut Incoming<T>, Arrived) -> Result<R, RecvError>> Decode<T, R> for D {}
