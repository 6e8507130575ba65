//! Accepts the TLS connections of the gateway's network library.
//!
//! The library accepts its connections through the crate `tls-listener`, with the functions that are defined here. The
//! crate of that name in the registry accepts any number of connections, and returns a failed handshake as an error,
//! after which the library accepts nothing for 100 ms: a thousand aborted connections keep all hosts out for minutes,
//! and occupy every file descriptor of the gateway. This crate limits unfinished handshakes, in total and for each
//! address, and does not return failed ones. Connections that have not sent a whole ClientHello are dropped first,
//! because a host sends it at once.

#![cfg_attr(test, allow(clippy::unwrap_used))]

mod rates;
mod source;

use rates::Rates;
use rustix::io::Errno;
use source::Source;
use std::collections::{HashMap, VecDeque};
use std::future::poll_fn;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::task::{AbortHandle, Id, JoinSet};
use tokio::time::timeout;
use tokio_rustls::rustls::ServerConfig;
use tokio_rustls::rustls::server::Acceptor;
use tokio_rustls::server::TlsStream;
use tokio_rustls::{LazyConfigAcceptor, TlsAcceptor};

/// Maximum number of unfinished handshakes: a quarter of the file descriptors that a process has at least. The rest is
/// for links and for the sockets of this host's components.
const MOST: usize = 256;
/// Maximum number of unfinished handshakes of one address.
const MOST_OF_ONE: usize = 64;

/// Maximum number of aborted handshakes that the runtime has not dropped yet: they still hold their file descriptors.
const MOST_ABORTED: usize = 64;

/// Settings of a listener.
pub struct Builder {
    config: Arc<ServerConfig>,
    limit: Duration,
}

/// Returns the settings of a listener with this TLS configuration.
pub fn builder(acceptor: TlsAcceptor) -> Builder {
    Builder { config: Arc::clone(acceptor.config()), limit: Duration::from_secs(1) }
}

impl Builder {
    /// Sets how long a handshake may take. Default: 1 s.
    pub fn handshake_timeout(&mut self, limit: Duration) -> &mut Self {
        self.limit = limit;
        self
    }

    /// Creates a listener that accepts connections from this socket.
    pub fn listen(&self, socket: TcpListener) -> TlsListener {
        TlsListener {
            socket,
            config: Arc::clone(&self.config),
            limit: self.limit,
            handshakes: JoinSet::new(),
            unfinished: VecDeque::new(),
            rates: Rates::default(),
        }
    }
}

/// Accepts TLS connections.
pub struct TlsListener {
    socket: TcpListener,
    config: Arc<ServerConfig>,
    limit: Duration,
    handshakes: JoinSet<io::Result<(TlsStream<TcpStream>, SocketAddr)>>,
    /// The oldest first.
    unfinished: VecDeque<Unfinished>,
    rates: Rates,
}

struct Unfinished {
    id: Id,
    source: Source,
    /// Whether the peer has sent a ClientHello.
    has_begun: Arc<AtomicBool>,
    task: AbortHandle,
}

impl TlsListener {
    /// Returns the next connection whose handshake is done.
    ///
    /// # Errors
    /// A connection cannot be accepted, for example without free file descriptors.
    ///
    /// # Cancel safety
    /// No connection is lost when the future is dropped.
    pub async fn accept(&mut self) -> io::Result<(TlsStream<TcpStream>, SocketAddr)> {
        poll_fn(|cx| self.poll_accept(cx)).await
    }

    fn poll_accept(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<(TlsStream<TcpStream>, SocketAddr)>> {
        loop {
            while let Poll::Ready(Some(ended)) = self.handshakes.poll_join_next_with_id(cx) {
                let (id, result) = match ended {
                    Ok((id, result)) => (id, result),
                    Err(aborted) => (aborted.id(), Err(io::ErrorKind::ConnectionAborted.into())),
                };
                self.unfinished.retain(|handshake| handshake.id != id);
                match result {
                    Ok(accepted) => return Poll::Ready(Ok(accepted)),
                    Err(error) => tracing::debug!(%error, "dropping a connection"),
                }
            }
            if self.handshakes.len() >= MOST + MOST_ABORTED {
                // The task is woken when any handshake ends.
                return Poll::Pending;
            }
            match self.socket.poll_accept(cx) {
                Poll::Ready(Ok((stream, address))) => self.begin(stream, address),
                Poll::Ready(Err(error)) => {
                    if matches!(Errno::from_io_error(&error), Some(Errno::MFILE | Errno::NFILE)) {
                        // Free the descriptors of unfinished handshakes: strangers may hold them, and real hosts retry.
                        self.handshakes.abort_all();
                    }
                    return Poll::Ready(Err(error));
                }
                Poll::Pending => return Poll::Pending,
            }
        }
    }

    /// Begins a handshake, unless the peer's address has begun too many.
    fn begin(&mut self, stream: TcpStream, address: SocketAddr) {
        let source = Source::of(address.ip());
        if !self.rates.take(source) {
            return;
        }
        let has_begun = Arc::new(AtomicBool::new(false));
        let handshake = handshake(stream, Arc::clone(&self.config), Arc::clone(&has_begun));
        let handshake = timeout(self.limit, handshake);
        let task = self.handshakes.spawn(async move { Ok((handshake.await??, address)) });
        self.unfinished.push_back(Unfinished { id: task.id(), source, has_begun, task });
        self.abort_surplus(source);
    }

    /// If there are too many handshakes, aborts one: of the newest connection's address if that has too many, otherwise
    /// of the address that has the most. Takes the oldest one without a ClientHello, or else the oldest.
    fn abort_surplus(&mut self, newest: Source) {
        let of_newest = self.unfinished.iter().filter(|handshake| handshake.source == newest).count();
        let surplus = match (of_newest > MOST_OF_ONE, self.unfinished.len() > MOST) {
            (true, _) => Some(newest),
            (false, true) => self.largest_source(),
            (false, false) => return,
        };
        let is_surplus = |handshake: &Unfinished| Some(handshake.source) == surplus;
        let is_silent = |handshake: &Unfinished| !handshake.has_begun.load(Ordering::Relaxed);
        // The newest handshake has had no time to send anything.
        let older = self.unfinished.len() - 1;
        let mut silent = self.unfinished.iter().take(older);
        let silent = silent.position(|handshake| is_surplus(handshake) && is_silent(handshake));
        let oldest = silent.or_else(|| self.unfinished.iter().position(is_surplus));
        if let Some(handshake) = oldest.and_then(|oldest| self.unfinished.remove(oldest)) {
            handshake.task.abort();
        }
    }

    /// Returns the address with the most unfinished handshakes. Of several, prefers the one that has the oldest
    /// handshake without a ClientHello, or else the oldest handshake.
    fn largest_source(&self) -> Option<Source> {
        let mut counts = HashMap::new();
        self.unfinished.iter().for_each(|handshake| *counts.entry(handshake.source).or_insert(0) += 1);
        let most = counts.values().max()?;
        let mut largest = self.unfinished.iter().filter(|handshake| counts.get(&handshake.source) == Some(most));
        let first = largest.clone().next()?;
        let silent = largest.find(|handshake| !handshake.has_begun.load(Ordering::Relaxed));
        Some(silent.unwrap_or(first).source)
    }
}

async fn handshake(
    stream: TcpStream,
    config: Arc<ServerConfig>,
    has_begun: Arc<AtomicBool>,
) -> io::Result<TlsStream<TcpStream>> {
    let begun = LazyConfigAcceptor::new(Acceptor::default(), stream).await?;
    has_begun.store(true, Ordering::Relaxed);
    begun.into_stream(config).await
}

#[cfg(test)]
mod tests;
