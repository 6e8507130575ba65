//! What `pub` and `push` share: a message is encoded once and offered to each connection.

use super::encoding::Encoding;
use super::stats::GateStats;
use super::{GateName, Outgoing, Peers};
use crate::codec::Codec;
use crate::component::Core;
use crate::error::{SendError, TrySendError};
use crate::spec::{GateKind, GateSpec, LinkSpec, WhenFull};
use crate::sync::lock;
use bytes::Bytes;
use std::future::poll_fn;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll};

pub(crate) struct Sending<T> {
    pub(crate) spec: &'static GateSpec,
    name: GateName,
    /// One a connection, in the order of `spec.links`; of a `pub` gate the tap comes last.
    connections: Vec<Arc<Mutex<Outgoing>>>,
    encoding: Encoding<T>,
    may_wait: bool,
    /// Whether each message goes to one of the peers only.
    shares: bool,
    /// Of a gate that shares, whose turn it is.
    turn: usize,
    /// How many comings and goings of peers were reported.
    reported: u64,
    pub(crate) core: Arc<Core>,
}

impl<T> Sending<T> {
    pub(crate) fn new<C: Codec<T>>(
        core: Arc<Core>,
        spec: &'static GateSpec,
        connections: Vec<Arc<Mutex<Outgoing>>>,
    ) -> Self {
        let may_wait = spec.backpressure && spec.links.iter().any(|link| link.when_full == WhenFull::Wait);
        let shares = spec.kind == GateKind::Push && connections.len() > 1;
        let name = GateName::new(core.spec().name, spec.name);
        let encoding = Encoding::with::<C>();
        Self { core, spec, name, connections, encoding, may_wait, shares, turn: 0, reported: 0 }
    }

    pub(crate) async fn send(&mut self, message: &T) -> Result<(), SendError> {
        let message = self.encode(message)?;
        if self.may_wait {
            poll_fn(|cx| self.poll_room(cx)).await;
        }
        // A program that does nothing but send lets the connections' tasks run now and then.
        tokio::task::coop::consume_budget().await;
        self.hand_out(&message);
        Ok(())
    }

    /// Sends after [`Self::poll_room`] was ready.
    pub(crate) fn send_now(&mut self, message: &T) -> Result<(), SendError> {
        let message = self.encode(message)?;
        self.hand_out(&message);
        Ok(())
    }

    pub(crate) fn send_blocking(&mut self, message: &T) -> Result<(), SendError> {
        let core = Arc::clone(&self.core);
        let sent = core.block_on(self.send(message));
        if self.spec.kind == GateKind::Push {
            core.with_a_turn(|| ());
        }
        sent.map_err(|source| SendError::Blocking { gate: self.name, source })?
    }

    pub(crate) fn try_send(&mut self, message: &T) -> Result<(), TrySendError> {
        let message = self.encode(message)?;
        let mut cx = Context::from_waker(std::task::Waker::noop());
        if self.may_wait && self.poll_room(&mut cx).is_pending() {
            return Err(TrySendError::Full { gate: self.name, peers: Peers(self.spec.links) });
        }
        self.hand_out(&message);
        Ok(())
    }

    /// Ready when no connection would make the message wait, so that it goes to all of them at once or to none.
    pub(crate) fn poll_room(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let mut waits = |connection: &Arc<Mutex<Outgoing>>| lock(connection).poll_room(cx).is_pending();
        // A tap never makes anybody wait.
        let mut peers = self.connections.iter().take(self.spec.links.len());
        let waiting = match self.shares {
            true => peers.all(&mut waits),
            // Only one of them needs to be waited for at a time.
            false => peers.any(&mut waits),
        };
        if waiting { Poll::Pending } else { Poll::Ready(()) }
    }

    pub(crate) fn poll_flushed(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        for connection in &self.connections {
            let mut connection = lock(connection);
            if !connection.is_flushed() {
                connection.wake_when_flushed(cx.waker());
                return Poll::Pending;
            }
        }
        Poll::Ready(())
    }

    pub(crate) async fn peers_changed(&mut self) -> usize {
        poll_fn(|cx| self.poll_peers_changed(cx)).await;
        self.stats().peers
    }

    fn poll_peers_changed(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let peers = self.connections.iter().take(self.spec.links.len());
        let changes = peers.map(|connection| lock(connection).watch_changes(cx.waker())).sum();
        if std::mem::replace(&mut self.reported, changes) == changes { Poll::Pending } else { Poll::Ready(()) }
    }

    fn encode(&mut self, message: &T) -> Result<Bytes, SendError> {
        self.encoding.encode(message).map_err(|source| SendError::Encode { gate: self.name, source })
    }

    fn hand_out(&mut self, message: &Bytes) {
        if self.shares {
            let turn = self.next_in_turn();
            return lock(&self.connections[turn]).send(message.clone());
        }
        for connection in &self.connections {
            lock(connection).send(message.clone());
        }
    }

    /// The next puller that can take a message now, or else whose queue can, or else that declared to drop one.
    fn next_in_turn(&mut self) -> usize {
        let count = self.connections.len();
        let turn = |offset| (self.turn + offset) % count;
        let next =
            |can: fn(&Outgoing) -> bool| (0..count).map(turn).find(|&index| can(&lock(&self.connections[index])));
        let with_room = || next(Outgoing::has_room).or_else(|| next(|connection| !connection.makes_wait()));
        let chosen = next(Outgoing::is_free).or_else(with_room).unwrap_or(self.turn % count);
        self.turn = chosen + 1;
        chosen
    }

    pub(crate) fn missing(&self) -> Vec<&'static LinkSpec> {
        let links = self.spec.links.iter().zip(&self.connections);
        links
            .filter(|(link, connection)| link.required && !lock(connection).is_connected())
            .map(|(link, _)| link)
            .collect()
    }

    pub(crate) fn stats(&self) -> GateStats {
        let mut stats = GateStats::default();
        for connection in self.connections.iter().take(self.spec.links.len()) {
            let connection = lock(connection);
            connection.counts().add_to(&mut stats);
            stats.sent += connection.counts().messages;
            stats.waiting += connection.waiting();
            stats.peers += usize::from(connection.is_connected());
        }
        stats
    }
}
