//! The variants over libzmq, on plain threads as its users have them.

use crate::libzmq::{HighWaterMark, without_timeout};
use crate::raw::SocketPaths;
use crate::worker::Worker;
use zmq2::{Context, REP, REQ, SUB, Socket, XPUB};

const MARK: HighWaterMark = HighWaterMark::Default;

/// The sockets of the side that measures.
pub(super) enum Client {
    Pub { ping: Socket, pong: Socket },
    Req(Socket),
}

impl Client {
    pub(super) fn start(id: &str, folder: &str, echo: &[&str]) -> scl::Result<(Self, Worker)> {
        let (context, paths) = (Context::new(), SocketPaths::new(folder, id));
        if id == "libzmq-req-blocking" {
            let request = paths.bind_libzmq(&context, "request", REQ, MARK)?;
            return Ok((Self::Req(request), Worker::start(echo)?));
        }
        let ping = paths.bind_libzmq(&context, "ping", XPUB, MARK)?;
        let echo = Worker::start(echo)?;
        let pong = paths.connect_libzmq(&context, "pong", SUB, MARK)?;
        let _subscription = ping.recv_bytes(0)?;
        Ok((Self::Pub { ping, pong }, echo))
    }

    pub(super) fn exchange(&mut self, payload: &[u8]) -> scl::Result<()> {
        let (sender, receiver) = match self {
            Self::Pub { ping, pong } => (&*ping, &*pong),
            Self::Req(request) => (&*request, &*request),
        };
        sender.send(payload, 0)?;
        receiver.recv_bytes(0)?;
        Ok(())
    }
}

pub(super) fn echo_published(paths: &SocketPaths) -> scl::Result<()> {
    let context = Context::new();
    let pong = paths.bind_libzmq(&context, "pong", XPUB, MARK)?;
    let ping = paths.connect_libzmq(&context, "ping", SUB, MARK)?;
    let _subscription = pong.recv_bytes(0)?;
    let ping = without_timeout(ping)?;
    loop {
        pong.send(ping.recv_bytes(0)?, 0)?;
    }
}

pub(super) fn echo_requests(paths: &SocketPaths) -> scl::Result<()> {
    let socket = without_timeout(paths.connect_libzmq(&Context::new(), "request", REP, MARK)?)?;
    loop {
        socket.send(socket.recv_bytes(0)?, 0)?;
    }
}
