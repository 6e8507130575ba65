//! Finding the listening side of an endpoint and connecting to it, at a constant pace.
//!
//! The library's own retries back off (to 30 s), and a connection that it retries cannot be called off. So an endpoint
//! is probed with a plain connection first; the library only ever connects to somebody who listens. If that one goes
//! away in between, the library would knock at its old address for ever: then another one at the endpoint, or none, is
//! the sign to call it off.

use crate::place::{self, Address, SystemDir};
use futures_core::Stream;
use std::os::unix::fs::MetadataExt;
use std::pin::Pin;
use std::task::{Context, Poll};
use std::time::Duration;
use std::{fs, io};
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::net::{TcpStream, UnixStream};
use zeromq::{Socket, SocketEvent, SocketOptions, ZmqResult};

/// The pause between two attempts; the jitter keeps many components from knocking in step.
const RETRY: Duration = Duration::from_millis(20);
const JITTER: Duration = Duration::from_millis(4);
/// After this many attempts in vain the neighbour may have been built for another contract.
const ATTEMPTS_BEFORE_LOOKING_AROUND: u32 = 50;

/// A socket type that connects to a listening end.
pub(super) trait Dials: Socket + 'static {
    /// What is used of a connected socket.
    type End: Send;

    /// Whether the probe is kept to notice the end of the peer, because the library would not.
    const KEEPS_PROBE: bool = false;

    /// What has to be done on each new connection before it is used; an error if the peer has just gone.
    fn prepare(&mut self) -> impl Future<Output = ZmqResult<()>> + Send {
        async { Ok(()) }
    }

    fn into_end(self) -> Self::End;
}

/// A connected socket.
pub(super) struct Dialled<S: Dials> {
    pub(super) end: S::End,
    pub(super) probe: Option<Probe>,
    events: Pin<Box<dyn Stream<Item = SocketEvent> + Send>>,
}

impl<S: Dials> Dialled<S> {
    /// Ready when the library reports that the peer left. A receiving socket notices that only while it is polled, so
    /// this is to be asked after a poll that found nothing.
    pub(super) fn poll_lost(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        loop {
            match self.events.as_mut().poll_next(cx) {
                Poll::Ready(Some(SocketEvent::Disconnected(_)) | None) => return Poll::Ready(()),
                Poll::Ready(Some(_)) => {}
                Poll::Pending => return Poll::Pending,
            }
        }
    }
}

/// A plain connection to the same listener, which ends when the listener's process does.
pub(super) struct Probe(Box<dyn Plain>);

trait Plain: AsyncRead + AsyncWrite + Send + Unpin {}
impl<S: AsyncRead + AsyncWrite + Send + Unpin> Plain for S {}

impl Probe {
    async fn connect(address: &Address) -> io::Result<Self> {
        Ok(Self(match address {
            Address::Ipc(path) => Box::new(UnixStream::connect(path).await?),
            Address::Tcp(address) => Box::new(TcpStream::connect(address).await?),
        }))
    }

    pub(super) async fn say(&mut self, words: &[u8]) -> io::Result<()> {
        self.0.write_all(words).await
    }

    /// Returns when the other side is gone.
    pub(super) async fn ended(&mut self) {
        // Whatever the listener says is of no use here.
        let mut greeting = [0; 128];
        while matches!(self.0.read(&mut greeting).await, Ok(1..)) {}
    }
}

/// Connects a fresh socket to an endpoint, however long it takes until somebody listens there.
pub(super) async fn dial<S: Dials>(place: &SystemDir, endpoint: &str) -> Dialled<S> {
    let mut attempt = 0_u32;
    loop {
        match try_dial(place, endpoint).await {
            Ok(connected) => return connected,
            Err(error) => tracing::trace!(endpoint, %error, "not connected yet"),
        }
        attempt = attempt.saturating_add(1);
        if attempt == ATTEMPTS_BEFORE_LOOKING_AROUND {
            warn_of_other_contracts(place, endpoint);
        }
        tokio::time::sleep(RETRY + JITTER.mul_f64(jitter(endpoint, attempt))).await;
    }
}

async fn try_dial<S: Dials>(place: &SystemDir, endpoint: &str) -> io::Result<Dialled<S>> {
    let listener = Listener::find(place, endpoint).ok_or(io::ErrorKind::NotFound)?;
    let probe = Some(Probe::connect(&listener.address).await?).filter(|_| S::KEEPS_PROBE);
    // Whoever accepted the probe accepts this too; its handshake may take long, for example while it is stopped.
    let mut options = SocketOptions::default();
    options.no_connect_timeout();
    let mut socket = S::with_options(options);
    // Asked for first, because a peer that leaves at once is reported only to those who asked before.
    let events = Box::pin(socket.monitor());
    let url = url(&listener.address);
    tokio::select! {
        connected = socket.connect(&url) => connected.map_err(io::Error::other)?,
        () = listener.replaced(place, endpoint) => return Err(io::ErrorKind::ConnectionAborted.into()),
    }
    socket.prepare().await.map_err(io::Error::other)?;
    Ok(Dialled { end: socket.into_end(), probe, events })
}

/// Who listens at an endpoint.
#[derive(PartialEq, Eq)]
struct Listener {
    address: Address,
    /// Tells a Unix socket from the next one of the same name.
    inode: Option<u64>,
}

impl Listener {
    fn find(place: &SystemDir, endpoint: &str) -> Option<Self> {
        let address = place::find(place, endpoint)?;
        let inode = match &address {
            Address::Ipc(path) => Some(fs::symlink_metadata(path).ok()?.ino()),
            Address::Tcp(_) => None,
        };
        Some(Self { address, inode })
    }

    /// Returns when somebody else listens there, or nobody.
    async fn replaced(&self, place: &SystemDir, endpoint: &str) {
        while Self::find(place, endpoint).as_ref() == Some(self) {
            tokio::time::sleep(RETRY).await;
        }
    }
}

fn url(address: &Address) -> String {
    match address {
        Address::Ipc(path) => format!("ipc://{}", path.display()),
        Address::Tcp(address) => format!("tcp://{address}"),
    }
}

fn warn_of_other_contracts(place: &SystemDir, endpoint: &str) {
    let Some((connection, contract)) = endpoint.rsplit_once('.') else { return };
    for other in place::other_contracts(place, connection, contract) {
        tracing::warn!(
            connection,
            "the other end was built for contract {}, this program for {contract}: the types or the codec of this \
             connection differ; build both programs from the same topology file",
            other.contract,
        );
    }
}

/// A number from 0 to 1 that differs between endpoints and attempts.
fn jitter(endpoint: &str, attempt: u32) -> f64 {
    let mix = |hash: u32, byte: u8| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193);
    f64::from(endpoint.bytes().fold(attempt.wrapping_mul(0x9E37_79B9), mix)) / f64::from(u32::MAX)
}
