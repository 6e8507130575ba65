//! A peer that speaks ZMTP byte by byte over a blocking stream, well or badly, as its test wants.

use crate::zmtp::{COMMAND, LONG, MORE, greeting, ready};
use crate::{Address, HANG_LIMIT, Stream};
use std::io::{self, ErrorKind, Read, Write};
use std::net::{Shutdown, TcpListener};
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::thread::park_timeout;
use std::time::{Duration, Instant};

/// A connection to an SCL program, used by hand.
#[derive(Debug)]
pub struct RawPeer {
    stream: Stream,
}

/// A frame as it arrived.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    /// `MORE`, `LONG` and `COMMAND`.
    pub flags: u8,
    /// The bytes.
    pub body: Vec<u8>,
}

impl RawPeer {
    /// Connects without saying anything.
    pub fn connect(address: &Address) -> Self {
        Self::try_connect(address).unwrap_or_else(|error| panic!("no connection to {address:?}: {error}"))
    }

    /// [`connect`](Self::connect), if a listener is there.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn try_connect(address: &Address) -> io::Result<Self> {
        Stream::connect(address).map(Self::new)
    }

    /// Uses a connection that is there.
    pub fn new(stream: Stream) -> Self {
        stream.limit_reads(HANG_LIMIT);
        stream.limit_writes(HANG_LIMIT);
        Self { stream }
    }

    /// Connects and completes the handshake as a socket of a type such as `SUB`.
    pub fn join(address: &Address, socket_type: &str) -> Self {
        let mut peer = Self::connect(address);
        peer.handshake(socket_type).unwrap_or_else(|error| panic!("{address:?} as {socket_type}: {error}"));
        peer
    }

    /// Exchanges greetings and READY commands; returns the peer's READY command.
    ///
    /// # Errors
    /// The connection was closed, or nothing came within the time limit.
    pub fn handshake(&mut self, socket_type: &str) -> io::Result<Frame> {
        self.send(&greeting())?;
        self.read_greeting()?;
        // libzmq sends its READY only now; so does everybody who follows the RFC.
        self.send(&ready(socket_type))?;
        self.frame()
    }

    /// Reads the peer's greeting.
    ///
    /// # Errors
    /// The connection was closed, or nothing came within the time limit.
    pub fn read_greeting(&mut self) -> io::Result<[u8; 64]> {
        let mut greeting = [0; 64];
        self.stream.read_exact(&mut greeting)?;
        Ok(greeting)
    }

    /// Sends bytes.
    ///
    /// # Errors
    /// The connection was closed, or nobody reads.
    pub fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.stream.write_all(bytes)
    }

    /// Sends pieces until an end of the connection, or until the other side takes none for a while.
    ///
    /// Returns the number of bytes sent, and whether the connection still stands.
    pub fn flood(&mut self, pieces: impl Iterator<Item = Vec<u8>>) -> (u64, bool) {
        const PATIENCE: Duration = Duration::from_millis(100);
        self.stream.limit_writes(PATIENCE);
        let mut sent = 0;
        for piece in pieces {
            match self.stream.write_all(&piece) {
                Ok(()) => sent += piece.len() as u64,
                Err(error) => return (sent, error.kind() == ErrorKind::WouldBlock),
            }
        }
        (sent, true)
    }

    /// The next frame.
    ///
    /// # Errors
    /// The connection was closed, or nothing came within the time limit.
    pub fn frame(&mut self) -> io::Result<Frame> {
        let mut head = [0; 2];
        self.stream.read_exact(&mut head)?;
        let [flags, mut length @ ..] = head.map(u64::from);
        if flags as u8 & LONG != 0 {
            let mut rest = [0; 8];
            rest[0] = head[1];
            self.stream.read_exact(&mut rest[1..])?;
            length = [u64::from_be_bytes(rest)];
        }
        let mut body = vec![0; length[0] as usize];
        self.stream.read_exact(&mut body)?;
        Ok(Frame { flags: flags as u8, body })
    }

    /// The next message; commands are skipped.
    ///
    /// # Errors
    /// The connection was closed, or nothing came within the time limit.
    pub fn message(&mut self) -> io::Result<Vec<Vec<u8>>> {
        let mut parts = Vec::new();
        loop {
            let frame = self.frame()?;
            if frame.flags & COMMAND != 0 {
                continue;
            }
            parts.push(frame.body);
            if frame.flags & MORE == 0 {
                return Ok(parts);
            }
        }
    }

    /// Reads until the other side closes the connection; returns what it said before.
    ///
    /// # Panics
    /// If the connection is still open after the time limit.
    #[track_caller]
    pub fn wait_until_closed(&mut self) -> Vec<u8> {
        let (mut received, mut buffer) = (Vec::new(), [0; 4096]);
        loop {
            match self.stream.read(&mut buffer) {
                Ok(0) => return received,
                Ok(count) => received.extend_from_slice(&buffer[..count]),
                Err(error) if error.kind() == ErrorKind::WouldBlock => panic!("the connection was not closed"),
                // Closed while unread data was left.
                Err(_) => return received,
            }
        }
    }

    /// Whether the other side has closed the connection. What it has said is discarded.
    pub fn is_closed(&mut self) -> bool {
        self.stream.limit_reads(Duration::from_micros(1));
        let mut buffer = [0; 4096];
        let closed = loop {
            match self.stream.read(&mut buffer) {
                Ok(0) => break true,
                Ok(_) => {}
                Err(error) => break error.kind() != ErrorKind::WouldBlock,
            }
        };
        self.stream.limit_reads(HANG_LIMIT);
        closed
    }

    /// Closes the sending direction.
    pub fn finish_sending(&self) {
        self.stream.shutdown(Shutdown::Write);
    }

    /// The stream itself.
    pub fn stream(&mut self) -> &mut Stream {
        &mut self.stream
    }
}

/// Listens at an endpoint in place of an SCL program.
#[derive(Debug)]
pub enum RawListener {
    /// On a Unix socket.
    Unix(UnixListener),
    /// On loopback TCP, with the port in a `.tcp` file.
    Tcp(TcpListener),
}

impl RawListener {
    /// Listens on a Unix socket at a path, which may not exist yet.
    pub fn unix(path: &Path) -> Self {
        let listener = UnixListener::bind(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        listener.set_nonblocking(true).expect("no waiting");
        Self::Unix(listener)
    }

    /// Listens on a TCP port of its own, and announces it in the file that belongs to an endpoint's path.
    pub fn tcp(path: &Path) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        listener.set_nonblocking(true).expect("no waiting");
        let address = listener.local_addr().expect("an address");
        std::fs::write(format!("{}.tcp", path.display()), address.to_string()).expect("announced");
        Self::Tcp(listener)
    }

    /// The next connection, if one is waiting.
    pub fn try_accept(&self) -> Option<RawPeer> {
        let stream = match self {
            Self::Unix(listener) => listener.accept().map(|(stream, _)| {
                stream.set_nonblocking(false).expect("blocking");
                Stream::Unix(stream)
            }),
            Self::Tcp(listener) => listener.accept().map(|(stream, _)| {
                stream.set_nonblocking(false).expect("blocking");
                Stream::Tcp(stream)
            }),
        };
        stream.ok().map(RawPeer::new)
    }

    /// Waits for the next connection.
    ///
    /// # Panics
    /// If nobody connects within the time limit.
    #[track_caller]
    pub fn accept(&self) -> RawPeer {
        let started = Instant::now();
        loop {
            if let Some(peer) = self.try_accept() {
                return peer;
            }
            assert!(started.elapsed() < HANG_LIMIT, "nobody connects");
            park_timeout(Duration::from_millis(1));
        }
    }
}
