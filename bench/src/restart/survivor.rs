//! The side that is not restarted, in this process.

use super::PERIOD;
use super::components::{Publisher, Puller, Pusher, Replier, Requester, Subscriber};
use crate::clock::now;
use crate::raw::SocketPaths;
use crate::worker::unknown_arguments;
use scl::bytes::{Buf, Bytes};
use scl::time::{Interval, interval};
use std::convert::Infallible;
use tokio::io::AsyncReadExt;
use tokio::net::UnixListener;
use zeromq::{PubSocket, Socket, SocketSend};

pub(super) enum Survivor {
    SclPub(Publisher),
    SclSub(Subscriber),
    SclPush(Pusher),
    SclPull(Puller),
    SclReq(Requester),
    SclRep(Replier),
    ZeromqPub(PubSocket),
    #[cfg(feature = "libzmq")]
    LibzmqPub(zmq2::Socket),
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
            "scl-publisher" => Self::SclSub(Subscriber::open_with(options).await?),
            "scl-subscriber" => Self::SclPub(Publisher::open_with(options).await?),
            "scl-pusher" => Self::SclPull(Puller::open_with(options).await?),
            "scl-puller" => Self::SclPush(Pusher::open_with(options).await?),
            "scl-requester" => Self::SclRep(Replier::open_with(options).await?),
            "scl-replier" => Self::SclReq(Requester::open_with(options).await?),
            "zeromq-subscriber" => {
                let mut socket = PubSocket::new();
                socket.bind(&paths.endpoint("stream")).await?;
                Self::ZeromqPub(socket)
            }
            #[cfg(feature = "libzmq")]
            "libzmq-publisher" => {
                let mark = crate::libzmq::HighWaterMark::Default;
                Self::LibzmqSub(paths.connect_libzmq(&zmq2::Context::new(), "stream", zmq2::SUB, mark)?)
            }
            #[cfg(feature = "libzmq")]
            "libzmq-subscriber" => {
                let mark = crate::libzmq::HighWaterMark::Default;
                Self::LibzmqPub(paths.bind_libzmq(&zmq2::Context::new(), "stream", zmq2::PUB, mark)?)
            }
            "unix" => Self::Unix(UnixListener::bind(paths.path("stream"))?),
            other => return Err(unknown_arguments(&[other])),
        })
    }

    /// A side that receives: waits for the first message of a run of the restarted side, and returns when it arrived.
    /// A side that sends does so until this is dropped: the restarted side notices the first message.
    pub(super) async fn exchange(&mut self, run: u32) -> scl::Result<u64> {
        let mut interval = interval(PERIOD)?;
        let never = match self {
            Self::SclSub(subscriber) => {
                while number(&subscriber.stream.recv().await?)? != run {}
                return Ok(now());
            }
            Self::SclPull(puller) => {
                while number(&puller.stream.recv().await?)? != run {}
                return Ok(now());
            }
            Self::SclReq(requester) => {
                // A call fails if the other side is killed before it replies.
                while !matches!(requester.stream.call(&Bytes::new()).await, Ok(reply) if number(&reply)? == run) {
                    interval.tick().await?;
                }
                return Ok(now());
            }
            #[cfg(feature = "libzmq")]
            Self::LibzmqSub(socket) => loop {
                match socket.recv_bytes(zmq2::DONTWAIT) {
                    Ok(message) if number(&message)? == run => return Ok(now()),
                    Ok(_previous_run) => {}
                    Err(zmq2::Error::EAGAIN) => interval.tick().await?,
                    Err(error) => return Err(error.into()),
                }
            },
            Self::Unix(listener) => {
                listener.accept().await?.0.read_u8().await?;
                return Ok(now());
            }
            Self::SclRep(replier) => reply_forever(replier).await?,
            sender => sender.send_forever(interval).await?,
        };
        match never {}
    }

    async fn send_forever(&mut self, mut interval: Interval) -> scl::Result<Infallible> {
        loop {
            interval.tick().await?;
            match self {
                Self::SclPub(publisher) => publisher.stream.send(&Bytes::new()).await?,
                Self::SclPush(pusher) => pusher.stream.send(&Bytes::new()).await?,
                Self::ZeromqPub(socket) => socket.send(Bytes::new().into()).await?,
                #[cfg(feature = "libzmq")]
                Self::LibzmqPub(socket) => socket.send(&[][..], 0)?,
                _ => return Err(scl::Error::message("this side does not send")),
            }
        }
    }
}

async fn reply_forever(replier: &mut Replier) -> scl::Result<Infallible> {
    loop {
        // Fails if the requester was killed after it sent the request.
        let _requester_lost = replier.stream.recv().await?.reply(&Bytes::new());
    }
}

/// The number of the run that sent a message.
fn number(mut message: &[u8]) -> scl::Result<u32> {
    Ok(message.try_get_u32()?)
}
