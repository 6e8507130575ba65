//! The sending side.

use super::batch::BatchSender;
use super::components::Source;
use super::message::Message;
use crate::raw::SocketPaths;
use crate::worker::{Worker, unknown_arguments};
use std::time::Duration;
use tokio::io::AsyncWriteExt;
use tokio::net::{UnixListener, UnixStream};
use tokio::runtime::Runtime;
use zeromq::{PushSocket, Socket, SocketRecv, SocketSend, XPubSocket};

const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

/// The sending end of a variant.
pub(super) enum Sender {
    SclPub(Source),
    SclPubBlocking(Source),
    SclPush(Source),
    SclPushBlocking(Source),
    ZeromqPub(XPubSocket),
    ZeromqPush(PushSocket),
    #[cfg(feature = "libzmq")]
    Libzmq(zmq2::Socket),
    #[cfg(feature = "libzmq")]
    LibzmqNodrop(Worker),
    Unix(UnixStream),
    /// The sender of another transport or library.
    Other(Box<dyn BatchSender>),
}

impl Sender {
    /// Starts the receiver of a variant with the given arguments, and connects to it.
    pub(super) fn start(
        runtime: &Runtime,
        id: &str,
        folder: &str,
        receiver: &[&str],
        bytes: usize,
        batch: usize,
    ) -> scl::Result<(Self, Worker)> {
        match id {
            "ipc" | "ipc-blocking" | "tcp" => Self::other(super::engines::start(runtime, id, folder, receiver)?),
            #[cfg(feature = "shm")]
            "shm-loan" | "shm-loan-blocking" | "shm-copy" | "shm-copy-blocking" => {
                Self::other(super::engines::start(runtime, id, folder, receiver)?)
            }
            #[cfg(feature = "shm")]
            "iceoryx-loan" | "iceoryx-copy" => {
                Self::other(super::iceoryx::start(runtime, id, folder, bytes, receiver)?)
            }
            #[cfg(feature = "gateway")]
            "gateway" => Self::other(super::engines::start_across_hosts(runtime, folder, receiver)?),
            #[cfg(feature = "gateway")]
            "zenoh" => Self::other(super::zenoh::start(runtime, receiver)?),
            "scl-pub-blocking" | "scl-push-blocking" => Self::start_blocking(id, folder, receiver),
            #[cfg(feature = "libzmq")]
            "libzmq-nodrop" => runtime.block_on(Self::start_nodrop(folder, receiver, bytes, batch)),
            _ => {
                #[cfg(not(feature = "libzmq"))]
                let _only_for_libzmq = (bytes, batch);
                runtime.block_on(Self::start_async(id, folder, receiver))
            }
        }
    }

    fn other((sender, receiver): (Box<dyn BatchSender>, Worker)) -> scl::Result<(Self, Worker)> {
        Ok((Self::Other(sender), receiver))
    }

    fn start_blocking(id: &str, folder: &str, receiver: &[&str]) -> scl::Result<(Self, Worker)> {
        let receiver = Worker::start(receiver)?;
        let source = Source::open_blocking_with(scl::OpenOptions::new().runtime_dir(folder).system(id))?;
        source.ready_blocking(CONNECT_TIMEOUT)?;
        let is_push = id == "scl-push-blocking";
        Ok((if is_push { Self::SclPushBlocking(source) } else { Self::SclPubBlocking(source) }, receiver))
    }

    #[cfg(feature = "libzmq")]
    async fn start_nodrop(folder: &str, receiver: &[&str], bytes: usize, batch: usize) -> scl::Result<(Self, Worker)> {
        let paths = SocketPaths::new(folder, "libzmq-nodrop");
        let mut publisher = crate::libzmq::start_lossless_publisher(&paths, "stream", bytes, batch)?;
        let _listening = publisher.next_line().await?;
        let receiver = Worker::start(receiver)?;
        let _subscribed = publisher.next_line().await?;
        Ok((Self::LibzmqNodrop(publisher), receiver))
    }

    async fn start_async(id: &str, folder: &str, receiver: &[&str]) -> scl::Result<(Self, Worker)> {
        let paths = SocketPaths::new(folder, id);
        let start_receiver = || Worker::start(receiver);
        Ok(match id {
            "scl-pub" | "scl-push" => {
                let receiver = start_receiver()?;
                let source = Source::open_with(scl::OpenOptions::new().runtime_dir(folder).system(id)).await?;
                source.ready(CONNECT_TIMEOUT).await?;
                (if id == "scl-push" { Self::SclPush(source) } else { Self::SclPub(source) }, receiver)
            }
            "zeromq-pub" => {
                let mut socket = paths.bind_xpub("stream").await?;
                let receiver = start_receiver()?;
                let _subscription = socket.recv().await?;
                (Self::ZeromqPub(socket), receiver)
            }
            "zeromq-push" => {
                let mut receiver = start_receiver()?;
                let _listening = receiver.next_line().await?;
                let mut socket = PushSocket::new();
                socket.connect(&paths.endpoint("stream")).await?;
                (Self::ZeromqPush(socket), receiver)
            }
            #[cfg(feature = "libzmq")]
            "libzmq-pub" | "libzmq-push" | "libzmq-push-unlimited" => {
                let socket = bind_libzmq(&paths, id)?;
                let receiver = start_receiver()?;
                if id == "libzmq-pub" {
                    let _subscription = socket.recv_bytes(0)?;
                }
                (Self::Libzmq(socket), receiver)
            }
            "unix" => {
                let listener = UnixListener::bind(paths.path("stream"))?;
                let receiver = start_receiver()?;
                (Self::Unix(listener.accept().await?.0), receiver)
            }
            other => return Err(unknown_arguments(&[other])),
        })
    }

    /// Sends a message many times, as fast as possible.
    pub(super) fn send_batch(&mut self, runtime: &Runtime, message: &Message, batch: usize) -> scl::Result<()> {
        match self {
            Self::Other(sender) => sender.send_batch(runtime, message, batch),
            Self::SclPubBlocking(source) => {
                for _ in 0..batch {
                    source.stream.send_blocking(&message.payload)?;
                }
                Ok(())
            }
            Self::SclPushBlocking(source) => {
                for _ in 0..batch {
                    source.jobs.send_blocking(&message.payload)?;
                }
                Ok(())
            }
            #[cfg(feature = "libzmq")]
            Self::LibzmqNodrop(publisher) => publisher.trigger(),
            _ => runtime.block_on(async {
                for _ in 0..batch {
                    self.send(message).await?;
                }
                Ok(())
            }),
        }
    }

    /// Sends one message, except for blocking variants.
    pub(super) async fn send(&mut self, message: &Message) -> scl::Result<()> {
        match self {
            Self::SclPub(source) => source.stream.send(&message.payload).await?,
            Self::SclPush(source) => source.jobs.send(&message.payload).await?,
            Self::ZeromqPub(socket) => socket.send(message.payload.clone().into()).await?,
            Self::ZeromqPush(socket) => socket.send(message.payload.clone().into()).await?,
            // Blocks this thread, which has nothing else to do: libzmq has threads of its own.
            #[cfg(feature = "libzmq")]
            Self::Libzmq(socket) => socket.send(&message.payload[..], 0)?,
            Self::Unix(stream) => stream.write_all(&message.frame).await?,
            _ => return Err(scl::Error::message("this variant sends whole batches only")),
        }
        Ok(())
    }
}

#[cfg(feature = "libzmq")]
fn bind_libzmq(paths: &SocketPaths, id: &str) -> scl::Result<zmq2::Socket> {
    use crate::libzmq::HighWaterMark;
    let (kind, mark) = match id {
        "libzmq-pub" => (zmq2::XPUB, HighWaterMark::Unlimited),
        "libzmq-push" => (zmq2::PUSH, HighWaterMark::Default),
        _ => (zmq2::PUSH, HighWaterMark::Unlimited),
    };
    paths.bind_libzmq(&zmq2::Context::new(), "stream", kind, mark)
}
