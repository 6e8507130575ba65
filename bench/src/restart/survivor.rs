//! The side that is not restarted, in this process.

use super::PERIOD;
use super::side::Side;
use crate::clock::now;
#[cfg(feature = "libzmq")]
use crate::ends::Receiver;
use crate::raw::SocketPaths;
use scl::bytes::{Buf, Bytes};
use scl::time::interval;
use tokio::io::AsyncReadExt;
use tokio::net::UnixListener;

pub(super) enum Survivor {
    Side(Side),
    Unix(UnixListener),
}

impl Survivor {
    /// Opens the side opposite to the one that a variant restarts.
    pub(super) async fn open(id: &str, folder: &str) -> scl::Result<Self> {
        Ok(match id {
            "unix" => Self::Unix(UnixListener::bind(SocketPaths::new(folder, id).path("stream"))?),
            _ => Self::Side(Side::open(id, false, folder).await?),
        })
    }

    /// If this side receives, waits for the first message that the restarted side sends in this run, and returns the
    /// time of its arrival. If this side sends, it does so until the future is dropped, because the restarted side
    /// reports the first message.
    pub(super) async fn exchange(&mut self, run: u32) -> scl::Result<u64> {
        let mut interval = interval(PERIOD)?;
        match self {
            Self::Side(Side::Sends(sender)) => loop {
                interval.tick().await?;
                sender.send(&Bytes::new().into()).await?;
            },
            // A blocking receive could not be cancelled by dropping this future.
            #[cfg(feature = "libzmq")]
            Self::Side(Side::Receives(Receiver::Libzmq(socket))) => loop {
                match socket.recv_bytes(zmq2::DONTWAIT) {
                    Ok(message) if number(&message)? == run => break,
                    Ok(_previous_run) => {}
                    Err(zmq2::Error::EAGAIN) => interval.tick().await?,
                    Err(error) => return Err(error.into()),
                }
            },
            Self::Side(Side::Receives(receiver)) => while number(&receiver.receive().await?.payload())? != run {},
            Self::Side(Side::Calls(gate)) => {
                // A call fails if the other side is killed before it replies.
                while !matches!(gate.call(&Bytes::new()).await, Ok(reply) if number(&reply)? == run) {
                    interval.tick().await?;
                }
            }
            Self::Side(Side::Replies(gate)) => loop {
                // Fails if the requester was killed after it sent the request.
                let _requester_lost = gate.recv().await?.reply(&Bytes::new());
            },
            Self::Unix(listener) => {
                listener.accept().await?.0.read_u8().await?;
            }
        }
        Ok(now())
    }
}

/// The number of the run that sent a message.
fn number(mut message: &[u8]) -> scl::Result<u32> {
    Ok(message.try_get_u32()?)
}
