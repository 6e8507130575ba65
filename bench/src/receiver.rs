//! The receiving end of a connection, of SCL or of what it is compared with.

use crate::message::Frame;
use crate::unix::FrameBuffer;
use scl::bytes::Bytes;
use scl::{Pull, Sub};
use std::os::unix::net::UnixStream as StdUnixStream;
use tokio::net::unix::OwnedReadHalf;
use zeromq::SocketRecv;

/// Of gates of SCL, whether their calls block.
pub(crate) enum Receiver {
    Sub(Sub<Bytes>, bool),
    Pull(Pull<Bytes>, bool),
    Zeromq(Box<dyn SocketRecv>),
    #[cfg(feature = "libzmq")]
    Libzmq(zmq2::Socket),
    Unix(OwnedReadHalf, FrameBuffer),
    UnixBlocking(StdUnixStream, FrameBuffer),
    #[cfg(feature = "shm")]
    Iceoryx(Box<crate::iceoryx::Receiving>),
    #[cfg(feature = "gateway")]
    Zenoh(crate::zenoh_peer::Receiving),
}

impl Receiver {
    pub(crate) async fn receive(&mut self) -> scl::Result<Frame<'_>> {
        Ok(match self {
            Self::Sub(gate, true) => Frame::Bytes(gate.recv_blocking()?),
            Self::Sub(gate, false) => Frame::Bytes(gate.recv().await?),
            Self::Pull(gate, true) => Frame::Bytes(gate.recv_blocking()?),
            Self::Pull(gate, false) => Frame::Bytes(gate.recv().await?),
            Self::Zeromq(socket) => Frame::Zeromq(socket.recv().await?),
            #[cfg(feature = "libzmq")]
            Self::Libzmq(socket) => Frame::Libzmq(socket.recv_msg(0)?),
            Self::Unix(stream, frames) => Frame::Unix(frames.read(stream).await?),
            Self::UnixBlocking(stream, frames) => Frame::Unix(frames.read_blocking(stream)?),
            #[cfg(feature = "shm")]
            Self::Iceoryx(receiving) => Frame::Iceoryx(receiving.receive()?),
            #[cfg(feature = "gateway")]
            Self::Zenoh(receiving) => Frame::Zenoh(receiving.receive()?),
        })
    }
}
