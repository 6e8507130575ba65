//! The ways over libzmq, the C++ library, each on a plain thread as its users have it.

use crate::processes::OtherProcess;
use crate::raw::RawPlace;
use zmq2::{Context, REP, REQ, Socket};

/// What sends there and what brings back; the same socket for requests.
pub(super) enum Ball {
    Publish { there: Socket, back: Socket },
    Call(Socket),
}

impl Ball {
    pub(super) fn start(word: &str, folder: &str, wall: &[&str]) -> scl::Result<(Self, OtherProcess)> {
        let (context, place) = (Context::new(), RawPlace::new(folder, word));
        if word == "libzmq-call-blocking" {
            let socket = place.bind_libzmq(&context, REQ, "question")?;
            return Ok((Self::Call(socket), OtherProcess::start(wall)?));
        }
        let there = place.publish_libzmq(&context, "there")?;
        let wall = OtherProcess::start(wall)?;
        let back = place.subscribe_libzmq(&context, "back")?;
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
    let back = place.publish_libzmq(&context, "back")?;
    let there = place.subscribe_libzmq(&context, "there")?;
    // The ball's subscription.
    back.recv_bytes(0)?;
    there.set_rcvtimeo(-1)?;
    loop {
        back.send(there.recv_bytes(0)?, 0)?;
    }
}

pub(super) fn send_back_asked(place: &RawPlace) -> scl::Result<()> {
    let socket = place.connect_libzmq(&Context::new(), REP, "question")?;
    socket.set_rcvtimeo(-1)?;
    loop {
        socket.send(socket.recv_bytes(0)?, 0)?;
    }
}
