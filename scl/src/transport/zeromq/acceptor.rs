//! Accepting connections and their handshakes.
//!
//! A process without free descriptors cannot accept, not even to find out that no connection is pending, and would
//! retry forever. So one descriptor is kept in reserve: with it, pending connections are accepted and closed at once,
//! and their peers retry.
//!
//! Over TCP every user of the machine can connect. Connections of other users are closed at once, without a handshake
//! and at a limited rate; they do not count towards the limits for connections of this user.

use super::TransportKind;
use super::listener::{Accepted, Listener};
use super::refusals::Refusals;
use super::session::{Closed, Session};
use super::shared_memory::Offer;
use super::stream::{Stream, is_blocked};
use super::tcp_user::UserChecks;
use super::timer::Timer;
use super::zmtp::{ConnectionId, Decoder, Item, PeerReady, ProtocolError, SclReady, SocketType, hello};
use crate::runtime_dir::{OwnedPath, Seen, SystemDir};
use crate::transport::{Endpoint, TransportError};
use bytes::Bytes;
use rustix::io::Errno;
use std::collections::VecDeque;
use std::fs::File;
use std::io;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::time::Instant;

/// How long a peer may take for its handshake.
pub(super) const HANDSHAKE_LIMIT: Duration = Duration::from_secs(5);
/// Maximum number of connections without a completed handshake. The oldest are closed first.
const MOST_HANDSHAKES: usize = 64;
/// Maximum number of connections of one endpoint.
pub(super) const MOST_CONNECTIONS: usize = 1024;
/// How many connections are accepted before other work gets its turn.
const ACCEPTS: usize = 64;
/// Delay before accepting again after an error that is likely to last.
const PAUSE: Duration = Duration::from_millis(50);
/// Delay before accepting again after connections of other users: they arrive one by one, and the delay lets them be
/// handled together.
const STRANGERS_PAUSE: Duration = Duration::from_millis(5);
/// Delay before binding is retried after it failed in a restored folder.
const RETRY: Duration = Duration::from_secs(1);

pub(super) struct Acceptor {
    pub(super) dir: Arc<SystemDir>,
    kind: TransportKind,
    pub(super) endpoint: Endpoint,
    socket: SocketType,
    connection: ConnectionId,
    scl: SclReady,
    hello: Bytes,
    /// Shared memory, if it is offered to peers.
    offer: Option<Offer>,
    runtime: Option<Handle>,
    listener: Listener,
    guard: OwnedPath,
    /// How many restorations of the folder this end has seen.
    restored: Seen,
    /// When to retry binding after it failed.
    retry: Timer,
    reserve: Option<File>,
    pause: Timer,
    handshakes: VecDeque<Handshake>,
    limit: Timer,
    refusals: Refusals,
    /// Connections beyond the limit.
    crowd: Refusals,
}

struct Handshake {
    session: Session,
    /// The shared memory service that the peer was offered.
    service: Option<u128>,
    deadline: Instant,
}

impl Acceptor {
    /// Binds the endpoint. Called inside a runtime.
    pub(super) fn open(
        dir: &Arc<SystemDir>,
        kind: TransportKind,
        endpoint: &Endpoint,
        socket: SocketType,
        scl: SclReady,
    ) -> Result<Self, TransportError> {
        let (listener, guard) = Listener::bind(dir, kind, &endpoint.name)?;
        let connection = ConnectionId::of(dir, &endpoint.name);
        let scl = SclReady { connection: Some(connection), ..scl };
        Ok(Self {
            dir: Arc::clone(dir),
            kind,
            endpoint: endpoint.clone(),
            socket,
            connection,
            scl,
            hello: hello(socket, scl).into(),
            offer: None,
            runtime: Handle::try_current().ok(),
            listener,
            guard,
            restored: Seen::default(),
            retry: Timer::default(),
            reserve: Some(reserve().map_err(|error| TransportError::refused(&endpoint.name, &error))?),
            pause: Timer::default(),
            handshakes: VecDeque::new(),
            limit: Timer::default(),
            refusals: Refusals::default(),
            crowd: Refusals::default(),
        })
    }

    /// Offers shared memory to peers if this end uses the transport `shm`.
    ///
    /// # Errors
    /// There is too little shared memory, or it cannot be used.
    pub(super) fn offering_memory(mut self) -> Result<Self, TransportError> {
        if self.kind == TransportKind::Shm {
            self.offer = Some(Offer::open(&self.dir, &self.endpoint)?);
        }
        Ok(self)
    }

    /// Prepares for calls without a runtime.
    pub(super) fn detach(&mut self) {
        self.runtime = None;
        self.pause.detach();
        self.limit.detach();
        self.handshakes.iter_mut().for_each(|handshake| handshake.session.detach());
    }

    /// Returns the next connection whose handshake is done. `open` is the number of connections in use.
    pub(super) fn poll_session(&mut self, cx: &mut Context<'_>, open: usize) -> Poll<(Session, PeerReady)> {
        self.bind_again_if_restored(cx);
        self.accept(cx, open);
        self.poll_handshakes(cx)
    }

    /// Binds again after the runtime folder was removed and restored. Existing connections stay.
    fn bind_again_if_restored(&mut self, cx: &mut Context<'_>) {
        let Some(runtime) = &self.runtime else { return };
        let mut is_due = self.retry.is_set() && self.retry.poll(cx).is_ready();
        while self.dir.poll_restored(&mut self.restored, cx).is_ready() {
            is_due = true;
        }
        // A restoration is also reported when only other files were removed, so check whether this one is still there.
        while is_due && !self.guard.is_ours() {
            let _inside = runtime.enter();
            match Listener::bind(&self.dir, self.kind, &self.endpoint.name) {
                Ok((listener, guard)) => (self.listener, self.guard) = (listener, guard),
                Err(error) => {
                    tracing::warn!(endpoint = %self.endpoint.name, %error, "cannot listen again");
                    self.retry.set(RETRY);
                    is_due = self.retry.poll(cx).is_ready();
                }
            }
        }
    }

    fn accept(&mut self, cx: &mut Context<'_>, open: usize) {
        if !self.pause.is_set()
            && let Some(next) = self.listener.next_check()
        {
            self.pause.set_at(next.into());
        }
        let mut arrived = Vec::new();
        let mut may_be_more = self.accept_waiting(cx, &mut arrived);
        if !arrived.is_empty() && self.admit(cx, arrived, open) > 0 {
            self.pause.set(STRANGERS_PAUSE);
            // Poll the pause, so that its end wakes the task.
            may_be_more = self.pause.poll(cx).is_ready();
        }
        if may_be_more {
            cx.waker().wake_by_ref();
        }
    }

    /// Accepts connections. Returns false if none is left; the task is woken for the next one.
    fn accept_waiting(&mut self, cx: &mut Context<'_>, arrived: &mut Vec<Accepted>) -> bool {
        for _ in 0..ACCEPTS {
            if self.pause.poll(cx).is_pending() {
                return false;
            }
            match self.poll_accept(cx) {
                Poll::Ready(Ok(accepted)) => arrived.push(accepted),
                Poll::Ready(Err(error)) => {
                    if is_out_of_descriptors(&error) {
                        // Dropped like the unfinished handshakes, so that some descriptors stay free for other sockets.
                        arrived.clear();
                    }
                    if self.handle_failure(cx, &error) {
                        return false;
                    }
                }
                Poll::Pending => return false,
            }
        }
        true
    }

    /// Begins the handshakes of this user's connections, and closes the others. Returns the number of connections of
    /// other users.
    fn admit(&mut self, cx: &mut Context<'_>, arrived: Vec<Accepted>, open: usize) -> usize {
        let mut checks = UserChecks::default();
        let mut refused = 0;
        for accepted in arrived {
            match accepted.check_user(&mut checks) {
                Ok(stream) if open + self.handshakes.len() < MOST_CONNECTIONS => self.start(stream),
                Ok(_one_too_many) => {
                    let reason = format!("{MOST_CONNECTIONS} peers are connected, the maximum for one gate");
                    self.crowd.log(&self.endpoint.name, &io::Error::other(reason));
                }
                Err(error) if error.kind() == io::ErrorKind::PermissionDenied => {
                    refused += 1;
                    self.refusals.log(&self.endpoint.name, &error);
                }
                Err(error) => {
                    self.handle_failure(cx, &error);
                }
            }
        }
        refused
    }

    fn poll_accept(&self, cx: &mut Context<'_>) -> Poll<io::Result<Accepted>> {
        if let Some(runtime) = &self.runtime {
            let _inside = runtime.enter();
            return self.listener.poll_accept(cx);
        }
        let accepted = self.listener.accept_raw();
        if is_blocked(&accepted) { Poll::Pending } else { Poll::Ready(accepted) }
    }

    fn start(&mut self, stream: Stream) {
        let decoder = Decoder::new(self.socket, self.endpoint.max_size);
        let shm = self.offer.as_ref().map(Offer::next);
        let own = shm.map(|_| hello(self.socket, SclReady { shm, ..self.scl }).into());
        let session = Session::new(stream, decoder, own.as_ref().unwrap_or(&self.hello));
        let service = shm.and_then(|shm| shm.service);
        self.handshakes.push_back(Handshake { session, service, deadline: Instant::now() + HANDSHAKE_LIMIT });
        if self.handshakes.len() > MOST_HANDSHAKES {
            self.handshakes.pop_front();
        }
    }

    /// Handles a failure to accept a connection. Returns true if no connection is pending; the task is woken for the
    /// next one.
    fn handle_failure(&mut self, cx: &mut Context<'_>, error: &io::Error) -> bool {
        tracing::debug!(endpoint = %self.endpoint.name, %error, "cannot accept a connection");
        match Errno::from_io_error(error) {
            _ if is_out_of_descriptors(error) => return self.turn_away(cx),
            // Only this connection failed, or the call was interrupted: try the next one.
            Some(Errno::CONNABORTED | Errno::INTR | Errno::NOTCONN | Errno::INVAL) => {}
            None => {}
            _ => self.pause.set(PAUSE),
        }
        false
    }

    /// Accepts and closes all pending connections, keeping the spare descriptor free for the next time. Returns true if
    /// none is left: without a free descriptor, the operating system would report an error even then.
    fn turn_away(&mut self, cx: &mut Context<'_>) -> bool {
        // Connections without a handshake are dropped as well; real peers will retry.
        self.handshakes.clear();
        self.reserve = None;
        let mut turned_away = 0;
        let none_left = loop {
            match self.poll_accept(cx) {
                Poll::Ready(Ok(_)) if turned_away < ACCEPTS => turned_away += 1,
                Poll::Ready(_) => break false,
                Poll::Pending => break true,
            }
        };
        self.reserve = reserve().ok();
        if self.reserve.is_none() || !none_left {
            self.pause.set(PAUSE);
        }
        if turned_away > 0 {
            tracing::warn!(turned_away, "no file descriptors are left for new connections; see `ulimit -n`");
        }
        none_left && self.reserve.is_some()
    }

    fn poll_handshakes(&mut self, cx: &mut Context<'_>) -> Poll<(Session, PeerReady)> {
        let mut index = 0;
        while let Some(handshake) = self.handshakes.get_mut(index) {
            match poll_handshake(&mut handshake.session, self.connection, cx) {
                Poll::Ready(Ok(peer)) => {
                    if let Some(handshake) = self.handshakes.remove(index) {
                        let can_share = peer.scl.is_some_and(|scl| scl.shm.is_some());
                        let service = handshake.service.filter(|_| can_share);
                        return Poll::Ready((handshake.session, PeerReady { service, ..peer }));
                    }
                }
                Poll::Ready(Err(error)) => {
                    tracing::debug!(endpoint = %self.endpoint.name, %error, "dropping a connection");
                    self.handshakes.remove(index);
                }
                Poll::Pending => index += 1,
            }
        }
        self.drop_silent_peers(cx);
        Poll::Pending
    }

    fn drop_silent_peers(&mut self, cx: &mut Context<'_>) {
        while let Some(oldest) = self.handshakes.front() {
            self.limit.set_at(oldest.deadline);
            if self.limit.poll(cx).is_pending() {
                return;
            }
            self.handshakes.pop_front();
        }
        self.limit.clear();
    }
}

/// Continues the handshake of a connection. Ready when the peer has sent READY.
pub(super) fn poll_handshake(
    session: &mut Session,
    connection: ConnectionId,
    cx: &mut Context<'_>,
) -> Poll<Result<PeerReady, Closed>> {
    if !session.is_written() {
        session.flush(cx)?;
    }
    Poll::Ready(match ready!(session.poll_item(cx))? {
        Item::Ready(peer) => Ok(peer.check(connection)?),
        _ => Err(ProtocolError::NotReady.into()),
    })
}

/// Whether the process, or the machine, has no free file descriptor.
pub(super) fn is_out_of_descriptors(error: &io::Error) -> bool {
    matches!(Errno::from_io_error(error), Some(Errno::MFILE | Errno::NFILE))
}

/// Occupies a descriptor, so that one is free for a socket once this is dropped.
pub(super) fn reserve() -> io::Result<File> {
    File::open("/dev/null")
}
