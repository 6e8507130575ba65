//! Sockets of libzmq, the C++ library.

mod lossless_publisher;

pub(crate) use lossless_publisher::start_lossless_publisher;

use crate::raw::SocketPaths;
use zmq2::{Context, SUB, Socket, SocketType};

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
    /// A socket that listens.
    pub(crate) fn bind_libzmq(
        &self,
        context: &Context,
        socket: &str,
        kind: SocketType,
        mark: HighWaterMark,
    ) -> scl::Result<Socket> {
        let bound = new_socket(context, kind, mark)?;
        bound.bind(&self.endpoint(socket))?;
        Ok(bound)
    }

    /// A socket that connects, and subscribes to everything if it is a SUB socket.
    pub(crate) fn connect_libzmq(
        &self,
        context: &Context,
        socket: &str,
        kind: SocketType,
        mark: HighWaterMark,
    ) -> scl::Result<Socket> {
        let connected = new_socket(context, kind, mark)?;
        connected.connect(&self.endpoint(socket))?;
        if kind == SUB {
            connected.set_subscribe(b"")?;
        }
        Ok(connected)
    }
}

/// A socket that gives up a receive after [`CONNECT_TIMEOUT`].
pub(crate) fn new_socket(context: &Context, kind: SocketType, mark: HighWaterMark) -> scl::Result<Socket> {
    let socket = context.socket(kind)?;
    socket.set_rcvtimeo(CONNECT_TIMEOUT)?;
    socket.set_linger(0)?;
    if mark == HighWaterMark::Unlimited {
        socket.set_sndhwm(0)?;
        socket.set_rcvhwm(0)?;
    }
    Ok(socket)
}

/// Lets a receive wait forever, because other variants have their turn between two batches.
pub(crate) fn without_timeout(socket: Socket) -> scl::Result<Socket> {
    socket.set_rcvtimeo(-1)?;
    Ok(socket)
}
