//! The side that is not restarted, in this process.

use super::PERIOD;
use crate::clock::now;
use crate::components::restart::{Publisher, Puller, Pusher, Replier, Requester, Subscriber};
use crate::link::open;
use crate::message::Frame;
use crate::raw::SocketPaths;
use crate::receiver::Receiver;
use crate::sender::{Calls, Sender};
use crate::worker::unknown_arguments;
use scl::bytes::{Buf, Bytes};
use scl::time::interval;
use scl::{Rep, Req};
use tokio::io::AsyncReadExt;
use tokio::net::UnixListener;

pub(super) enum Survivor {
    Sends(Sender),
    Receives(Receiver),
    Calls(Req<Bytes, Bytes>),
    Replies(Rep<Bytes, Bytes>),
    #[cfg(feature = "libzmq")]
    LibzmqSub(zmq2::Socket),
    Unix(UnixListener),
}

impl Survivor {
    /// Opens the opposite of the restarted side.
    pub(super) async fn open(restarted: &str, folder: &str) -> scl::Result<Self> {
        let options = scl::OpenOptions::new().runtime_dir(folder).system(restarted);
        let paths = SocketPaths::new(folder, restarted);
        Ok(match restarted {
            "scl-publisher" => Self::Receives(Receiver::Sub(open!(Subscriber, options, false).stream, false)),
            "scl-subscriber" => Self::Sends(Sender::Pub(open!(Publisher, options, false).stream, Calls::default())),
            "scl-pusher" => Self::Receives(Receiver::Pull(open!(Puller, options, false).stream, false)),
            "scl-puller" => Self::Sends(Sender::Push(open!(Pusher, options, false).stream, Calls::default())),
            "scl-requester" => Self::Replies(open!(Replier, options, false).stream),
            "scl-replier" => Self::Calls(open!(Requester, options, false).stream),
            "zeromq-subscriber" => Self::Sends(Sender::Zeromq(Box::new(paths.bind_pub("stream").await?))),
            #[cfg(feature = "libzmq")]
            "libzmq-publisher" => {
                let mark = crate::libzmq::HighWaterMark::Default;
                Self::LibzmqSub(paths.connect_libzmq("stream", zmq2::SUB, mark)?)
            }
            #[cfg(feature = "libzmq")]
            "libzmq-subscriber" => {
                let mark = crate::libzmq::HighWaterMark::Default;
                Self::Sends(Sender::Libzmq(paths.bind_libzmq("stream", zmq2::PUB, mark)?))
            }
            "unix" => Self::Unix(UnixListener::bind(paths.path("stream"))?),
            other => return Err(unknown_arguments(&[other])),
        })
    }

    /// A side that receives: waits for the first message of a run of the restarted side, and returns when it arrived.
    /// A side that sends does so until this is dropped: the restarted side notices the first message.
    pub(super) async fn exchange(&mut self, run: u32) -> scl::Result<u64> {
        let mut interval = interval(PERIOD)?;
        match self {
            Self::Sends(sender) => loop {
                interval.tick().await?;
                sender.send(Frame::Bytes(Bytes::new())).await?;
            },
            Self::Receives(receiver) => while number(&receiver.receive().await?.payload())? != run {},
            Self::Calls(gate) => {
                // A call fails if the other side is killed before it replies.
                while !matches!(gate.call(&Bytes::new()).await, Ok(reply) if number(&reply)? == run) {
                    interval.tick().await?;
                }
            }
            Self::Replies(gate) => loop {
                // Fails if the requester was killed after it sent the request.
                let _requester_lost = gate.recv().await?.reply(&Bytes::new());
            },
            // A call that blocks could not be dropped.
            #[cfg(feature = "libzmq")]
            Self::LibzmqSub(socket) => loop {
                match socket.recv_bytes(zmq2::DONTWAIT) {
                    Ok(message) if number(&message)? == run => break,
                    Ok(_previous_run) => {}
                    Err(zmq2::Error::EAGAIN) => interval.tick().await?,
                    Err(error) => return Err(error.into()),
                }
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
