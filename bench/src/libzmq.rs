//! Sockets of libzmq, the C++ library, for the ways that stand beside ours.

use crate::raw::RawPlace;
use zmq2::{Context, SUB, Socket, SocketType, XPUB};

/// How long the two sides may take to find each other, in milliseconds.
const PATIENCE: i32 = 10_000;

impl RawPlace {
    /// A socket that listens.
    pub(crate) fn bind_libzmq(&self, context: &Context, kind: SocketType, end: &str) -> scl::Result<Socket> {
        let socket = patient(context, kind)?;
        socket.bind(&self.zeromq(end))?;
        Ok(socket)
    }

    /// A socket that dials.
    pub(crate) fn connect_libzmq(&self, context: &Context, kind: SocketType, end: &str) -> scl::Result<Socket> {
        let socket = patient(context, kind)?;
        socket.connect(&self.zeromq(end))?;
        Ok(socket)
    }

    /// A publisher that keeps whatever a subscriber cannot take yet. By default it would drop messages beyond 1000.
    pub(crate) fn publish_libzmq(&self, context: &Context, end: &str) -> scl::Result<Socket> {
        let socket = patient(context, XPUB)?;
        socket.set_sndhwm(0)?;
        socket.bind(&self.zeromq(end))?;
        Ok(socket)
    }

    /// A subscriber of everything.
    pub(crate) fn subscribe_libzmq(&self, context: &Context, end: &str) -> scl::Result<Socket> {
        let socket = patient(context, SUB)?;
        socket.set_rcvhwm(0)?;
        socket.connect(&self.zeromq(end))?;
        socket.set_subscribe(b"")?;
        Ok(socket)
    }
}

fn patient(context: &Context, kind: SocketType) -> scl::Result<Socket> {
    let socket = context.socket(kind)?;
    socket.set_rcvtimeo(PATIENCE)?;
    socket.set_linger(0)?;
    Ok(socket)
}
