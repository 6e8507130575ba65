//! The connections of a sending gate: each encoded message goes over all of them, or over one of them in turn.

use super::due::SharedDue;
use super::stats::{GateStats, PeerStats};
use super::tap::{GateTap, ObservedKind};
use super::watch::Watch;
use super::{Connection, exceeded};
use crate::codec::EncodeError;
use crate::error::{BlockingError, GateName, Missing, PeerName, SendError, SendTimeoutError, TrySendError};
use crate::figures::FigureSource;
use crate::runtime_dir::GateFigures;
use crate::spec::{ConnectionSpec, GateKind, GateSpec};
use crate::state::{Owner, SendingEnd};
use crate::sync::lock;
use crate::transport::{HeapMemory, Loan};
use bytes::Bytes;
use std::future::poll_fn;
use std::sync::{Arc, Mutex, Weak};
use std::task::{Context, Poll, Waker};
use std::time::Duration;

/// The connections of a sending gate.
pub(crate) struct Fanout {
    pub(crate) spec: &'static GateSpec,
    pub(super) name: GateName,
    /// One per peer, in the order of `spec.connections`.
    connections: Vec<Arc<Mutex<Connection>>>,
    tap: GateTap,
    due: SharedDue,
    may_wait: bool,
    /// Whether each message goes to one of the peers only.
    shares: bool,
    /// The connection whose turn it is, if the gate shares.
    turn: usize,
    /// The peer that accepts the shortest messages.
    pub(super) strictest: Option<&'static ConnectionSpec>,
    /// Number of connects and disconnects reported by `peers_changed`.
    reported: u64,
    /// Dropped with the gate, whose connections may live longer.
    open: Arc<()>,
    pub(crate) state: Owner,
}

/// A message as a gate's connections get it.
pub(super) enum Outbound {
    Bytes(Bytes),
    /// Memory lent by the connection at this index.
    Loan(Loan, usize),
}

impl Outbound {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Bytes(bytes) => bytes.len(),
            Self::Loan(loan, _) => loan.len(),
        }
    }
}

impl Fanout {
    pub(crate) fn new(
        state: Owner,
        spec: &'static GateSpec,
        connections: Vec<Arc<Mutex<Connection>>>,
        tap: GateTap,
    ) -> Self {
        let may_wait = spec.connections.iter().any(|connection| spec.options.waits_for(connection.when_full));
        let shares = spec.kind == GateKind::Push && connections.len() > 1;
        let name = GateName::new(state.spec.name, spec.name);
        let strictest = spec.connections.iter().min_by_key(|connection| connection.max_size);
        Self {
            spec,
            name,
            connections,
            tap,
            due: SharedDue::promised(spec.options.period),
            may_wait,
            shares,
            turn: 0,
            strictest,
            reported: 0,
            open: Arc::default(),
            state,
        }
    }

    /// Encodes a message, if the gate can be used, and checks that each peer accepts its length.
    pub(super) fn accept(&self, encode: impl FnOnce() -> Result<Outbound, EncodeError>) -> Result<Outbound, SendError> {
        self.state.check().map_err(self.refused())?;
        self.encoded(encode)
    }

    fn encoded(&self, encode: impl FnOnce() -> Result<Outbound, EncodeError>) -> Result<Outbound, SendError> {
        let message = encode().map_err(|source| SendError::Encode { gate: self.name, source })?;
        match exceeded(self.strictest, message.len()) {
            Some((peer, size, limit)) => Err(SendError::TooLong { gate: self.name, peer, size, limit }),
            None => Ok(message),
        }
    }

    /// Sends a message that was accepted.
    pub(super) async fn send(&mut self, message: Outbound) -> Result<(), SendError> {
        if self.may_wait || self.state.is_stopped() {
            poll_fn(|cx| self.poll_room(cx)).await?;
        }
        // Yield now and then, so that the connections' tasks run even if the program does nothing but send.
        tokio::task::coop::consume_budget().await;
        self.hand_out(message);
        Ok(())
    }

    pub(super) fn send_blocking(
        &mut self,
        encode: impl FnOnce() -> Result<Outbound, EncodeError>,
    ) -> Result<(), SendError> {
        self.state.may_block().map_err(self.refused())?;
        let message = self.accept(encode)?;
        if self.may_wait {
            let state = Arc::clone(&self.state);
            state.block_on(poll_fn(|cx| self.poll_room(cx))).map_err(self.refused())??;
        }
        self.hand_out(message);
        self.state.take_turn();
        Ok(())
    }

    pub(super) fn send_timeout(
        &mut self,
        encode: impl FnOnce() -> Result<Outbound, EncodeError>,
        timeout: Duration,
    ) -> Result<(), SendTimeoutError> {
        self.state.may_block().map_err(self.refused())?;
        let message = self.accept(encode)?;
        if self.may_wait {
            let state = Arc::clone(&self.state);
            let waited = state.block_on_for(timeout, poll_fn(|cx| self.poll_room(cx))).map_err(self.refused())?;
            waited.unwrap_or(Ok(()))?;
            // After a timeout, check once more: room that has appeared since then is good enough.
            if let Some(peer) = self.full(&mut Context::from_waker(Waker::noop())) {
                return Err(SendTimeoutError::Timeout { gate: self.name, peer, waited: timeout });
            }
        }
        self.hand_out(message);
        self.state.take_turn();
        Ok(())
    }

    pub(super) fn try_send(
        &mut self,
        encode: impl FnOnce() -> Result<Outbound, EncodeError>,
    ) -> Result<(), TrySendError> {
        self.state.may_proceed().map_err(self.refused())?;
        let message = self.accept(encode)?;
        if self.may_wait {
            let full = self.full(&mut Context::from_waker(Waker::noop()));
            if let Some(peer) = full {
                self.state.take_turn();
                return Err(TrySendError::Full { gate: self.name, peer });
            }
        }
        self.hand_out(message);
        self.state.take_turn();
        Ok(())
    }

    /// Sends without waiting, also after a stop request, and does not prove that the program is alive. Returns false if
    /// the message would have to wait.
    #[cfg(feature = "logging")]
    pub(super) fn offer(&mut self, encode: impl FnOnce() -> Result<Outbound, EncodeError>) -> Result<bool, SendError> {
        self.state.check_silently().map_err(self.refused())?;
        let message = self.encoded(encode)?;
        let has_room = !self.may_wait || self.full(&mut Context::from_waker(Waker::noop())).is_none();
        if has_room {
            self.hand_out(message);
        }
        Ok(has_room)
    }

    /// The names under which SCL logs of this gate: its own, and those of its sockets.
    #[cfg(feature = "logging")]
    pub(crate) fn names(&self) -> Vec<String> {
        let endpoints = self.spec.connections.iter().map(|connection| connection.endpoint.to_owned());
        std::iter::once(self.name.to_string()).chain(endpoints).collect()
    }

    /// Ready when no connection would make the message wait, so that it goes to all of them at once or to none.
    pub(crate) fn poll_room(&mut self, cx: &mut Context<'_>) -> Poll<Result<(), SendError>> {
        // After a stop request, calls stay pending until the futures that await them are dropped.
        let pending = self.state.is_stopped() || self.full(cx).is_some();
        // Check after the waker was registered, so that `end_calls` is not missed.
        match self.state.check() {
            Err(source) => Poll::Ready(Err(SendError::Blocking { gate: self.name, source })),
            Ok(()) if pending => Poll::Pending,
            Ok(()) => Poll::Ready(Ok(())),
        }
    }

    pub(crate) fn poll_flushed(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let mut flushed = self.connections.iter().map(|connection| lock(connection).poll_flushed(false, cx));
        if flushed.all(|flushed| flushed.is_ready()) { Poll::Ready(()) } else { Poll::Pending }
    }

    pub(crate) async fn peers_changed(&mut self) -> usize {
        poll_fn(|cx| self.poll_peers_changed(cx)).await;
        self.stats().peers
    }

    /// Returns memory for a message and the index of the connection that lends it, or memory from the heap if none
    /// lends any.
    pub(super) fn lend(&self, length: usize, alignment: usize) -> (Loan, Option<usize>) {
        let fits = |loan: &Loan| loan.len() == length && loan.as_slice().as_ptr().addr().is_multiple_of(alignment);
        let count = self.connections.len();
        // A gate that shares its messages among peers will most likely send over the connection whose turn it is.
        let lenders = (0..count).map(|offset| (self.turn + offset) % count);
        let mut lent = lenders.filter_map(|index| {
            let loan = lock(&self.connections[index]).loan(length).filter(fits)?;
            Some((loan, Some(index)))
        });
        lent.next().unwrap_or_else(|| (Loan::new(HeapMemory::zeroed(length, alignment)), None))
    }

    fn refused(&self) -> impl Fn(BlockingError) -> SendError + use<> {
        let gate = self.name;
        move |source| SendError::Blocking { gate, source }
    }

    /// The peer whose queue would make a message wait, if any.
    fn full(&self, cx: &mut Context<'_>) -> Option<PeerName> {
        let mut full = self
            .connections
            .iter()
            .map(|connection| lock(connection))
            .filter_map(|mut connection| connection.poll_room(cx).is_pending().then(|| connection.peer_name()));
        let first = full.next();
        // A gate that shares its messages among peers needs room at only one of them.
        let others = if self.shares { full.count() } else { 0 };
        first.filter(|_| !self.shares || others + 1 == self.connections.len())
    }

    fn poll_peers_changed(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let changes = self.connections.iter().map(|connection| lock(connection).watch_changes(cx.waker())).sum();
        if std::mem::replace(&mut self.reported, changes) == changes { Poll::Pending } else { Poll::Ready(()) }
    }

    /// Sends a message after [`Self::poll_room`] was ready.
    pub(super) fn hand_out(&mut self, message: Outbound) {
        self.due.add();
        let message = match message {
            Outbound::Bytes(bytes) => bytes,
            Outbound::Loan(loan, lender) => return self.hand_out_loan(loan, lender),
        };
        self.tap.observe(ObservedKind::Message, 0, &message);
        if self.shares {
            let turn = self.next_in_turn();
            return lock(&self.connections[turn]).send(message.into());
        }
        for connection in &self.connections {
            lock(connection).send(message.clone().into());
        }
    }

    /// The connection that lent the memory sends it as it is; the others, and observers, share one copy.
    fn hand_out_loan(&mut self, loan: Loan, lender: usize) {
        let mut copy = None;
        let mut shared = || copy.get_or_insert_with(|| Bytes::copy_from_slice(loan.as_slice())).clone();
        self.tap.observe_with(ObservedKind::Message, 0, &mut shared);
        if self.shares {
            let turn = self.next_in_turn();
            return lock(&self.connections[turn]).send(loan.into());
        }
        for (index, connection) in self.connections.iter().enumerate() {
            if index != lender {
                lock(connection).send(shared().into());
            }
        }
        lock(&self.connections[lender]).send(loan.into());
    }

    /// Chooses the next puller that can take a message now, or else one whose queue has room, or else one whose full
    /// queue drops messages.
    fn next_in_turn(&mut self) -> usize {
        let count = self.connections.len();
        let turn = |offset| (self.turn + offset) % count;
        let next =
            |can: fn(&Connection) -> bool| (0..count).map(turn).find(|&index| can(&lock(&self.connections[index])));
        let with_room = || next(Connection::has_room).or_else(|| next(|connection| !connection.would_wait()));
        let chosen = next(Connection::is_free).or_else(with_room).unwrap_or(self.turn % count);
        self.turn = chosen + 1;
        chosen
    }

    pub(crate) fn missing(&self) -> Vec<Missing> {
        self.connections.iter().filter_map(|connection| lock(connection).missing()).collect()
    }

    pub(crate) fn watch(&self) -> Watch {
        let connections: Vec<Weak<Mutex<Connection>>> = self.connections.iter().map(Arc::downgrade).collect();
        Watch::new(self.spec, move || {
            let connections = connections.iter().filter_map(Weak::upgrade);
            connections.filter_map(|connection| lock(&connection).missing()).collect()
        })
    }

    pub(crate) fn figures(&self) -> FigureSource {
        let connections: Vec<Weak<Mutex<Connection>>> = self.connections.iter().map(Arc::downgrade).collect();
        let (open, dropped) = (Arc::downgrade(&self.open), self.tap.dropped_later());
        let missed_later = self.due.missed_later();
        Box::new(move |figures| {
            // Check this first: connections may outlive their gate, until their peers have taken everything.
            let is_open = open.strong_count() > 0;
            if connections.iter().any(|connection| connection.strong_count() == 0) {
                return is_open;
            }
            // Those of a gate that was dropped stay.
            let missed = missed_later().unwrap_or(figures.missed);
            figures.set(GateFigures { missed, ..GateFigures::default() });
            for (index, connection) in connections.iter().enumerate() {
                let Some(connection) = connection.upgrade() else { continue };
                let mut connection = lock(&connection);
                connection.request_acknowledgement();
                figures.connections[index] = connection.add_to_figures(figures);
            }
            figures.tap_dropped = dropped();
            figures.dropped_for_observers += figures.tap_dropped;
            is_open
        })
    }

    pub(crate) fn peer_stats(&self) -> Vec<PeerStats> {
        self.connections.iter().map(|connection| lock(connection).stats()).collect()
    }

    pub(crate) fn stats(&self) -> GateStats {
        GateStats::of(|figures| {
            figures.dropped_for_observers = self.tap.dropped();
            figures.missed = self.due.missed();
            for connection in &self.connections {
                let own = lock(connection).add_to_figures(figures);
                figures.waiting += own.in_flight;
            }
        })
    }
}

/// Leaves the connections to the component, which frees their sockets once the remaining messages are handed over, or
/// after a time limit.
impl Drop for Fanout {
    fn drop(&mut self) {
        if self.state.is_inherited() {
            return;
        }
        for connection in self.connections.drain(..) {
            self.state.release(connection);
        }
    }
}
