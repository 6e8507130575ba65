//! Sockets of libzmq, the C++ library.

mod lossless_publisher;

pub(crate) use lossless_publisher::start_lossless_publisher;

use crate::raw::SocketPaths;
use zmq2::{Context, PULL, PUSH, SUB, Socket, SocketType, XPUB};

/// How long a receive may take while two processes connect, in milliseconds.
const CONNECT_TIMEOUT: i32 = 10_000;

/// How many messages a socket queues.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum HighWaterMark {
    /// libzmq's default of 1000.
    Default,
    /// As many as fit into memory.
    Unlimited,
}

impl SocketPaths {
    /// Opens a socket that listens.
    pub(crate) fn bind_libzmq(&self, socket: &str, kind: SocketType, mark: HighWaterMark) -> scl::Result<Socket> {
        let bound = new_socket(kind, mark)?;
        bound.bind(&self.endpoint(socket))?;
        Ok(bound)
    }

    /// Opens a socket that connects, and subscribes to everything if it is a SUB socket.
    pub(crate) fn connect_libzmq(&self, socket: &str, kind: SocketType, mark: HighWaterMark) -> scl::Result<Socket> {
        let connected = new_socket(kind, mark)?;
        connected.connect(&self.endpoint(socket))?;
        if kind == SUB {
            connected.set_subscribe(b"")?;
        }
        Ok(connected)
    }

    /// Opens a SUB socket that keeps only the newest message and whose receives wait without limit.
    pub(crate) fn connect_conflated(&self, socket: &str) -> scl::Result<Socket> {
        let connected = new_socket(SUB, HighWaterMark::Default)?;
        connected.set_rcvtimeo(-1)?;
        // Takes effect only if it is set before the socket connects.
        connected.set_conflate(true)?;
        connected.set_subscribe(b"")?;
        connected.connect(&self.endpoint(socket))?;
        Ok(connected)
    }
}

/// Creates a socket whose receives time out after [`CONNECT_TIMEOUT`].
fn new_socket(kind: SocketType, mark: HighWaterMark) -> scl::Result<Socket> {
    let socket = Context::new().socket(kind)?;
    socket.set_rcvtimeo(CONNECT_TIMEOUT)?;
    socket.set_linger(0)?;
    if mark == HighWaterMark::Unlimited {
        socket.set_sndhwm(0)?;
        socket.set_rcvhwm(0)?;
    }
    Ok(socket)
}

/// Returns the socket type and the high-water mark of a variant's sending end.
pub(crate) fn sending_kind(id: &str) -> (SocketType, HighWaterMark) {
    match id {
        "libzmq-push" => (PUSH, HighWaterMark::Default),
        "libzmq-push-unlimited" => (PUSH, HighWaterMark::Unlimited),
        "libzmq-pub" => (XPUB, HighWaterMark::Unlimited),
        _ => (XPUB, HighWaterMark::Default),
    }
}

/// Returns the socket type and the high-water mark of a variant's receiving end.
pub(crate) fn receiving_kind(id: &str) -> (SocketType, HighWaterMark) {
    let (kind, mark) = sending_kind(id);
    (if kind == PUSH { PULL } else { SUB }, mark)
}
