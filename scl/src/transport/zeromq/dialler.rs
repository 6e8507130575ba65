//! Connecting to the listening side of an endpoint, again and again.
//!
//! A peer that is expected back soon is tried every 20 ms, one that stays away twice a second. As soon as a file
//! arrives in the folder, it is tried every 20 ms again, because a peer that starts puts its socket or address there.
//!
//! While an end is not connected, it keeps a descriptor in reserve for its next attempt. Otherwise, it
//! could not connect while connections of another gate use up all descriptors of the process.

use super::acceptor::{HANDSHAKE_LIMIT, is_out_of_descriptors, poll_handshake, reserve};
use super::session::{Closed, Session};
use super::stream::{Socket, Stream};
use super::tcp_user::UserChecks;
use super::timer::Timer;
use super::zmtp::{ConnectionId, Decoder, PeerReady, SclReady, ShmReady, SocketType, hello};
use crate::runtime_dir::{self, Address, Seen, SystemDir};
use crate::transport::Endpoint;
use bytes::Bytes;
use rustix::io::Errno;
use rustix::net::addr::SocketAddrArg;
use rustix::net::{AddressFamily, SocketAddrUnix, SocketFlags, SocketType as Kind, socket_with};
use std::fs::File;
use std::io;
use std::net::SocketAddr;
use std::os::fd::OwnedFd;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::Duration;
use tokio::net::{TcpStream, UnixStream};
use tokio::runtime::Handle;

/// Delay between connection attempts. The jitter keeps components from retrying in lockstep.
const RETRY: Duration = Duration::from_millis(20);
const JITTER: Duration = Duration::from_millis(4);
/// Number of attempts per check of a peer that does not listen, so that it is checked every half second.
const ATTEMPTS_PER_CHECK: u32 = 24;
/// Number of attempts after which a peer counts as one that stays away, if events of the folder tell of its return.
const QUICK_ATTEMPTS: u32 = ATTEMPTS_PER_CHECK;
/// Delay between attempts to connect to such a peer.
const SLOW_RETRY: Duration = Duration::from_millis(500);

pub(super) struct Dialler {
    pub(super) dir: Arc<SystemDir>,
    pub(super) endpoint: Endpoint,
    socket: SocketType,
    connection: ConnectionId,
    hello: Bytes,
    runtime: Option<Handle>,
    /// Runs from one attempt until the next one may be made.
    pause: Timer,
    handshake: Option<Session>,
    limit: Timer,
    /// Its descriptor is for the next attempt.
    reserve: Option<File>,
    /// Number of failed attempts since the last connection.
    attempts: u32,
    /// The same since a file arrived in the folder.
    attempts_since_arrival: u32,
    /// The arrivals of files that this end has seen.
    arrived: Seen,
    refusal: Option<String>,
    /// The last reason that was logged, so that it is logged once.
    warned: Option<String>,
}

impl Dialler {
    /// Creates a dialler. Called inside a runtime.
    pub(super) fn new(dir: &Arc<SystemDir>, endpoint: &Endpoint, socket: SocketType, scl: SclReady) -> Self {
        let connection = ConnectionId::of(dir, &endpoint.name);
        let scl = SclReady { shm: ShmReady::of_dialling(socket), connection: Some(connection), ..scl };
        Self {
            dir: Arc::clone(dir),
            endpoint: endpoint.clone(),
            socket,
            connection,
            hello: hello(socket, scl).into(),
            runtime: Handle::try_current().ok(),
            pause: Timer::default(),
            handshake: None,
            limit: Timer::default(),
            reserve: reserve().ok(),
            attempts: 0,
            attempts_since_arrival: 0,
            arrived: Seen::default(),
            refusal: None,
            warned: None,
        }
    }

    /// Prepares for calls without a runtime.
    pub(super) fn detach(&mut self) {
        self.runtime = None;
        self.pause.detach();
        self.limit.detach();
        if let Some(session) = &mut self.handshake {
            session.detach();
        }
    }

    pub(super) fn refusal(&self) -> Option<String> {
        self.refusal.clone()
    }

    /// Returns a connection whose handshake is done. After it broke, call this again for the next one. If the
    /// connection lasted longer than the delay between two attempts, the next attempt is made at once.
    pub(super) fn poll_connected(&mut self, cx: &mut Context<'_>) -> Poll<(Session, PeerReady)> {
        loop {
            // The socket of the lost connection, or of the failed attempt, was closed just now.
            if self.handshake.is_none() && self.reserve.is_none() {
                self.reserve = reserve().ok();
            }
            match ready!(self.poll_attempt(cx)) {
                Ok(connected) => {
                    self.attempts = 0;
                    self.attempts_since_arrival = 0;
                    self.warned = None;
                    return Poll::Ready(connected);
                }
                Err(error) => self.handle_failure(&error),
            }
        }
    }

    fn poll_attempt(&mut self, cx: &mut Context<'_>) -> Poll<Result<(Session, PeerReady), Closed>> {
        let mut session = match self.handshake.take() {
            Some(session) => session,
            None => {
                ready!(self.poll_pause(cx));
                let pause = if self.is_slow() { SLOW_RETRY } else { RETRY };
                self.pause.set(pause + JITTER.mul_f64(jitter(&self.endpoint.name, self.attempts)));
                self.limit.set(HANDSHAKE_LIMIT);
                self.connect()?
            }
        };
        match poll_handshake(&mut session, self.connection, cx) {
            Poll::Ready(ready) => {
                // Otherwise, the timer would wake the task for nothing.
                self.limit.clear();
                Poll::Ready(ready.map(|peer| (session, peer)))
            }
            Poll::Pending => {
                if self.limit.poll(cx).is_ready() {
                    return Poll::Ready(Err(Closed::SilentPeer));
                }
                self.handshake = Some(session);
                Poll::Pending
            }
        }
    }

    /// Waits until the next attempt may be made.
    fn poll_pause(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        if self.is_slow() {
            while self.dir.poll_arrived(&mut self.arrived, cx).is_ready() {
                self.attempts_since_arrival = 0;
                self.pause.clear();
            }
        }
        self.pause.poll(cx)
    }

    fn is_slow(&self) -> bool {
        self.attempts_since_arrival >= QUICK_ATTEMPTS && self.runtime.is_some() && self.dir.reports_arrivals()
    }

    fn connect(&mut self) -> io::Result<Session> {
        self.reserve = None;
        let address = runtime_dir::find(&self.dir, &self.endpoint.name);
        // A peer with another type or codec listens at another endpoint, so check for one now and then even if nothing
        // listens at this one.
        if address.is_some() || self.attempts % ATTEMPTS_PER_CHECK == ATTEMPTS_PER_CHECK - 1 || self.is_slow() {
            self.refusal = self.endpoint.check.as_ref().and_then(|check| check().err());
        }
        if let Some(refusal) = self.refusal.clone() {
            self.warn_once(&refusal);
            return Err(io::ErrorKind::PermissionDenied.into());
        }
        let stream = match address.ok_or(io::ErrorKind::NotFound)? {
            Address::Ipc(path) => {
                let socket = connect(AddressFamily::UNIX, &SocketAddrUnix::new(&*path)?)?;
                self.adopt(socket, |socket| UnixStream::from_std(socket.into()).map(Socket::Unix))?
            }
            Address::Tcp(address) => {
                let socket = connect_to_own_user(address).inspect_err(|error| {
                    if error.kind() == io::ErrorKind::PermissionDenied {
                        self.warn_once(&error.to_string());
                    }
                })?;
                self.adopt(socket, |socket| TcpStream::from_std(socket.into()).map(Socket::Tcp))?
            }
        };
        let decoder = Decoder::new(self.socket, self.endpoint.max_size);
        Ok(Session::new(stream, decoder, &self.hello))
    }

    /// Registers a socket with the runtime. Without a runtime, the socket stays as it is.
    fn adopt(&self, descriptor: OwnedFd, in_runtime: fn(OwnedFd) -> io::Result<Socket>) -> io::Result<Stream> {
        let Some(runtime) = &self.runtime else { return Ok(Stream::new(Socket::Plain(descriptor))) };
        let _inside = runtime.enter();
        in_runtime(descriptor).map(Stream::new)
    }

    fn handle_failure(&mut self, error: &Closed) {
        tracing::trace!(endpoint = %self.endpoint.name, %error, "not connected yet");
        if let Closed::Protocol(error) = error {
            self.warn_once(&error.to_string());
        }
        self.attempts = self.attempts.saturating_add(1);
        // These errors say nothing about the peer: no file descriptor is free, its user cannot be checked now, or its
        // backlog is full.
        let unknown = |error: &io::Error| is_out_of_descriptors(error) || error.kind() == io::ErrorKind::WouldBlock;
        if !matches!(error, Closed::Io(error) if unknown(error)) {
            self.attempts_since_arrival = self.attempts_since_arrival.saturating_add(1);
        }
    }

    fn warn_once(&mut self, reason: &str) {
        if self.warned.as_deref() != Some(reason) {
            tracing::warn!("not connecting to `{}`: {reason}", self.endpoint.name);
            self.warned = Some(reason.to_owned());
        }
    }
}

/// Connects if the program that listens belongs to this program's user.
fn connect_to_own_user(address: SocketAddr) -> io::Result<OwnedFd> {
    let mut checks = UserChecks::default();
    let listener = checks.check_listener(address)?;
    let family = if address.is_ipv4() { AddressFamily::INET } else { AddressFamily::INET6 };
    let stream = connect(family, &address)?;
    // The port may have been released and bound by another user in between.
    if !checks.is_same_listener(address, listener)? {
        return Err(io::ErrorKind::ConnectionRefused.into());
    }
    Ok(stream)
}

/// Starts connecting; later reads and writes report the outcome.
fn connect(family: AddressFamily, address: &impl SocketAddrArg) -> io::Result<OwnedFd> {
    let socket = socket_with(family, Kind::STREAM, SocketFlags::CLOEXEC | SocketFlags::NONBLOCK, None)?;
    if family != AddressFamily::UNIX {
        rustix::net::sockopt::set_tcp_nodelay(&socket, true)?;
    }
    match rustix::net::connect(&socket, address) {
        Ok(()) | Err(Errno::INPROGRESS) => Ok(socket),
        Err(error) => Err(error.into()),
    }
}

/// A number from 0 to 1 that differs between endpoints and attempts.
fn jitter(endpoint: &str, attempt: u32) -> f64 {
    let mix = |hash: u32, byte: u8| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193);
    f64::from(endpoint.bytes().fold(attempt.wrapping_mul(0x9E37_79B9), mix)) / f64::from(u32::MAX)
}
