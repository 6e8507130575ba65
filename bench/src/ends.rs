//! The sending and the receiving end of a connection, of SCL or of what it is compared with.

use crate::message::{Frame, Message};
use crate::unix::FrameBuffer;
use scl::bytes::Bytes;
use scl::{Pub, Pull, Push, Sub};
use std::io::Write;
use std::os::unix::net::UnixStream as StdUnixStream;
use tokio::io::AsyncWriteExt;
use tokio::net::unix::{OwnedReadHalf, OwnedWriteHalf};
use zeromq::{SocketRecv, SocketSend, XPubSocket};

/// How gates of SCL are called.
#[derive(Clone, Copy, Default)]
pub(crate) struct Calls {
    pub(crate) is_blocking: bool,
    /// Whether messages are sent as loans.
    pub(crate) is_loaned: bool,
}

pub(crate) enum Sender {
    Pub(Pub<Bytes>, Calls),
    Push(Push<Bytes>, Calls),
    /// Shows when a subscriber has connected.
    Xpub(XPubSocket),
    Zeromq(Box<dyn SocketSend>),
    #[cfg(feature = "libzmq")]
    Libzmq(zmq2::Socket),
    /// Sends whole batches, when it is triggered.
    #[cfg(feature = "libzmq")]
    LibzmqNodrop(crate::worker::Worker),
    Unix(OwnedWriteHalf),
    UnixBlocking(StdUnixStream),
    #[cfg(feature = "shm")]
    Iceoryx(Box<crate::iceoryx::Sending>),
    #[cfg(feature = "gateway")]
    Zenoh(crate::zenoh_peer::Sending),
}

impl Calls {
    /// The calls of a variant.
    pub(crate) fn of(id: &str) -> Self {
        Self { is_blocking: id.ends_with("-blocking"), is_loaned: id.contains("-loan") }
    }
}

impl Sender {
    /// Waits until the other end has subscribed, where that can be known and matters.
    pub(crate) async fn ready(&mut self) -> scl::Result<()> {
        match self {
            Self::Xpub(socket) => drop(socket.recv().await?),
            #[cfg(feature = "libzmq")]
            Self::Libzmq(socket) if socket.get_socket_type()? == zmq2::XPUB => drop(socket.recv_bytes(0)?),
            #[cfg(feature = "libzmq")]
            Self::LibzmqNodrop(publisher) => drop(publisher.next_line().await?),
            #[cfg(feature = "gateway")]
            Self::Zenoh(sending) => sending.wait_for_subscriber()?,
            _ => {}
        }
        Ok(())
    }

    /// Sends a message that this process made. In one step, because a benchmark of a rate notices every other one.
    pub(crate) async fn send(&mut self, message: &Message) -> scl::Result<()> {
        let payload = &message.payload;
        match self {
            Self::Pub(gate, calls) if calls.is_loaned => {
                let mut loan = gate.loan_bytes(payload.len())?;
                if let Some(time) = message.time {
                    loan[..size_of::<u64>()].copy_from_slice(&time.to_be_bytes());
                }
                if calls.is_blocking { loan.send_blocking()? } else { loan.send().await? }
            }
            Self::Pub(gate, calls) if calls.is_blocking => gate.send_blocking(payload)?,
            Self::Pub(gate, _) => gate.send(payload).await?,
            Self::Push(gate, calls) if calls.is_blocking => gate.send_blocking(payload)?,
            Self::Push(gate, _) => gate.send(payload).await?,
            Self::Xpub(socket) => socket.send(payload.clone().into()).await?,
            Self::Zeromq(socket) => socket.send(payload.clone().into()).await?,
            // May block this thread, which has nothing else to do: libzmq has its own I/O threads.
            #[cfg(feature = "libzmq")]
            Self::Libzmq(socket) => socket.send(&payload[..], 0)?,
            #[cfg(feature = "libzmq")]
            Self::LibzmqNodrop(_) => return Err(scl::Error::message("this variant sends whole batches only")),
            Self::Unix(stream) => stream.write_all(&message.frame).await?,
            Self::UnixBlocking(stream) => stream.write_all(&message.frame)?,
            #[cfg(feature = "shm")]
            Self::Iceoryx(sending) => sending.send(payload.len(), None, message.time.unwrap_or_default())?,
            #[cfg(feature = "gateway")]
            Self::Zenoh(sending) => sending.send(payload.clone())?,
        }
        Ok(())
    }

    /// Sends a message that this process has received with the same transport or library.
    pub(crate) async fn send_back(&mut self, frame: Frame<'_>) -> scl::Result<()> {
        match (self, frame) {
            (sender, Frame::Bytes(payload)) => sender.send(&payload.into()).await?,
            (Self::Xpub(socket), Frame::Zeromq(message)) => socket.send(message).await?,
            #[cfg(feature = "libzmq")]
            (Self::Libzmq(socket), Frame::Libzmq(message)) => socket.send(message, 0)?,
            (Self::Unix(stream), Frame::Unix(frame)) => stream.write_all(frame).await?,
            (Self::UnixBlocking(stream), Frame::Unix(frame)) => stream.write_all(frame)?,
            #[cfg(feature = "shm")]
            (Self::Iceoryx(sending), Frame::Iceoryx(sample)) => {
                let payload = sample.payload();
                sending.send(payload.len(), Some(payload), *sample.user_header())?;
            }
            #[cfg(feature = "gateway")]
            (Self::Zenoh(sending), Frame::Zenoh(sample)) => sending.send(sample.payload().clone())?,
            _ => return Err(scl::Error::message("an end sends only what it has received itself")),
        }
        Ok(())
    }
}

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

    /// Receives a message and drops it, without the cost of a [`Frame`] for gates of SCL.
    pub(crate) async fn skip(&mut self) -> scl::Result<()> {
        match self {
            Self::Sub(gate, false) => drop(gate.recv().await?),
            Self::Pull(gate, false) => drop(gate.recv().await?),
            _ => drop(self.receive().await?),
        }
        Ok(())
    }
}
