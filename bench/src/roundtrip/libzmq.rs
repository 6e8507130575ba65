//! The ways over libzmq, the C++ library, each on a plain thread as its users have it.

use crate::processes::OtherProcess;
use crate::raw::RawPlace;
use zmq2::{Context, REP, REQ, SUB, Socket, SocketType, XPUB};

/// How long the two sides may take to find each other, in milliseconds.
const PATIENCE: i32 = 10_000;

/// What sends there and what brings back; the same socket for requests.
pub(super) enum Ball {
    Publish { there: Socket, back: Socket },
    Call(Socket),
}

impl Ball {
    pub(super) fn start(word: &str, folder: &str, wall: &[&str]) -> scl::Result<(Self, OtherProcess)> {
        let (context, place) = (Context::new(), RawPlace::new(folder, word));
        if word == "libzmq-call-blocking" {
            let socket = bound(&context, REQ, &place, "question")?;
            return Ok((Self::Call(socket), OtherProcess::start(wall)?));
        }
        let there = bound(&context, XPUB, &place, "there")?;
        let wall = OtherProcess::start(wall)?;
        let back = connected(&context, SUB, &place, "back")?;
        back.set_subscribe(b"")?;
        // The wall's subscription.
        there.recv_bytes(0)?;
        Ok((Self::Publish { there, back }, wall))
    }

    pub(super) fn exchange(&mut self, payload: &[u8]) -> scl::Result<()> {
        let (there, back) = match self {
            Self::Publish { there, back } => (&*there, &*back),
            Self::Call(socket) => (&*socket, &*socket),
        };
        there.send(payload, 0)?;
        back.recv_bytes(0)?;
        Ok(())
    }
}

pub(super) fn send_back_published(place: &RawPlace) -> scl::Result<()> {
    let context = Context::new();
    let back = bound(&context, XPUB, place, "back")?;
    let there = connected(&context, SUB, place, "there")?;
    there.set_subscribe(b"")?;
    // The ball's subscription.
    back.recv_bytes(0)?;
    there.set_rcvtimeo(-1)?;
    loop {
        back.send(there.recv_bytes(0)?, 0)?;
    }
}

pub(super) fn send_back_asked(place: &RawPlace) -> scl::Result<()> {
    let socket = connected(&Context::new(), REP, place, "question")?;
    socket.set_rcvtimeo(-1)?;
    loop {
        socket.send(socket.recv_bytes(0)?, 0)?;
    }
}

fn bound(context: &Context, kind: SocketType, place: &RawPlace, end: &str) -> scl::Result<Socket> {
    let socket = patient(context, kind)?;
    socket.bind(&place.zeromq(end))?;
    Ok(socket)
}

fn connected(context: &Context, kind: SocketType, place: &RawPlace, end: &str) -> scl::Result<Socket> {
    let socket = patient(context, kind)?;
    socket.connect(&place.zeromq(end))?;
    Ok(socket)
}

fn patient(context: &Context, kind: SocketType) -> scl::Result<Socket> {
    let socket = context.socket(kind)?;
    socket.set_rcvtimeo(PATIENCE)?;
    socket.set_linger(0)?;
    Ok(socket)
}
