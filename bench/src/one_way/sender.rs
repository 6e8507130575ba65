//! The side that sends.

use super::components::Source;
use crate::processes::{OtherProcess, wrong_words};
use crate::raw::RawPlace;
use scl::bytes::Bytes;
use std::time::Duration;
use tokio::io::AsyncWriteExt;
use tokio::net::{UnixListener, UnixStream};
use zeromq::{PushSocket, Socket, SocketRecv, SocketSend, XPubSocket};

const PATIENCE: Duration = Duration::from_secs(10);

/// The sending end of a way.
pub(super) enum Sender {
    SclPublish(Source),
    SclPush(Source),
    RawPublish(XPubSocket),
    RawPush(PushSocket),
    #[cfg(feature = "libzmq")]
    Libzmq(zmq2::Socket),
    Unix(UnixStream),
}

impl Sender {
    /// Starts the receiver of a way and connects to it.
    pub(super) async fn start(word: &str, folder: &str, receiver: &[&str]) -> scl::Result<(Self, OtherProcess)> {
        let place = RawPlace::new(folder, word);
        let start_receiver = || OtherProcess::start(receiver);
        Ok(match word {
            "scl-publish" | "scl-push" => {
                let receiver = start_receiver()?;
                let source = Source::open_with(scl::OpenOptions::new().runtime_dir(folder).system(word)).await?;
                source.ready(PATIENCE).await?;
                (if word == "scl-push" { Self::SclPush(source) } else { Self::SclPublish(source) }, receiver)
            }
            "raw-publish" => {
                let mut socket = place.publish("stream").await?;
                let receiver = start_receiver()?;
                // The receiver's subscription.
                socket.recv().await?;
                (Self::RawPublish(socket), receiver)
            }
            "raw-push" => {
                let mut receiver = start_receiver()?;
                receiver.line().await?;
                let mut socket = PushSocket::new();
                socket.connect(&place.zeromq("stream")).await?;
                (Self::RawPush(socket), receiver)
            }
            #[cfg(feature = "libzmq")]
            "libzmq-publish" => {
                let socket = place.publish_libzmq(&zmq2::Context::new(), "stream")?;
                let receiver = start_receiver()?;
                // The receiver's subscription.
                socket.recv_bytes(0)?;
                (Self::Libzmq(socket), receiver)
            }
            #[cfg(feature = "libzmq")]
            "libzmq-push" => {
                let socket = place.connect_libzmq(&zmq2::Context::new(), zmq2::PUSH, "stream")?;
                (Self::Libzmq(socket), start_receiver()?)
            }
            "unix" => {
                let listener = UnixListener::bind(place.socket("stream"))?;
                let receiver = start_receiver()?;
                (Self::Unix(listener.accept().await?.0), receiver)
            }
            other => return Err(wrong_words(&[other])),
        })
    }

    pub(super) async fn send(&mut self, message: Bytes) -> scl::Result<()> {
        match self {
            Self::SclPublish(source) => source.stream.send(&message).await?,
            Self::SclPush(source) => source.jobs.send(&message).await?,
            Self::RawPublish(socket) => socket.send(message.into()).await?,
            Self::RawPush(socket) => socket.send(message.into()).await?,
            // It may block this thread, which has nothing else to do: the library's threads do the work.
            #[cfg(feature = "libzmq")]
            Self::Libzmq(socket) => socket.send(&message[..], 0)?,
            Self::Unix(stream) => stream.write_all(&message).await?,
        }
        Ok(())
    }
}
