//! The receiving side.

use super::Timing;
use super::batch::{Batch, BatchReceiver};
use super::components::Sink;
use crate::raw::{SocketPaths, first_frame};
use crate::runtime::start_runtime;
use crate::unix::{FrameBuffer, PREFIX};
use crate::worker::{print_line, unknown_arguments};
use tokio::net::UnixStream;
use tokio::runtime::Runtime;
use zeromq::{PullSocket, Socket, SocketRecv, SubSocket};

/// Receives batches forever. The arguments are the variant's id, the scratch folder, the message size, the size of a
/// batch, and the timing.
pub(crate) fn run_receiver(arguments: &[&str]) -> scl::Result<()> {
    let [id, folder, bytes, batch, timing, rest @ ..] = arguments else { return Err(unknown_arguments(arguments)) };
    let (bytes, batch) = (bytes.parse()?, batch.parse()?);
    let has_delays = *timing == Timing::EachMessage.id();
    let runtime = start_runtime()?;
    let mut receiver = Receiver::open(&runtime, id, folder, bytes, rest)?;
    loop {
        let mut batch = Batch::new(batch, has_delays);
        receiver.receive_batch(&runtime, &mut batch)?;
        print_line(&batch.report().to_line())?;
    }
}

/// The receiving end of a variant.
enum Receiver {
    SclPub(Sink),
    SclPubBlocking(Sink),
    SclPush(Sink),
    SclPushBlocking(Sink),
    ZeromqPub(SubSocket),
    ZeromqPush(PullSocket),
    #[cfg(feature = "libzmq")]
    Libzmq(zmq2::Socket),
    Unix(UnixStream, FrameBuffer),
    /// The receiver of another transport or library.
    Other(Box<dyn BatchReceiver>),
}

impl Receiver {
    fn open(runtime: &Runtime, id: &str, folder: &str, bytes: usize, rest: &[&str]) -> scl::Result<Self> {
        #[cfg(not(feature = "gateway"))]
        let _only_for_gateway = rest;
        let paths = SocketPaths::new(folder, id);
        let options = scl::OpenOptions::new().runtime_dir(folder).system(id);
        match id {
            "ipc" | "ipc-blocking" | "tcp" | "gateway" | "shm-loan" | "shm-loan-blocking" | "shm-copy"
            | "shm-copy-blocking" => {
                return Ok(Self::Other(super::engines::open(runtime, id, folder)?));
            }
            #[cfg(feature = "shm")]
            "iceoryx-loan" | "iceoryx-copy" => return Ok(Self::Other(super::iceoryx::open(id, folder)?)),
            #[cfg(feature = "gateway")]
            "zenoh" => return Ok(Self::Other(super::zenoh::open(rest)?)),
            "scl-pub-blocking" => return Ok(Self::SclPubBlocking(Sink::open_blocking_with(options)?)),
            "scl-push-blocking" => return Ok(Self::SclPushBlocking(Sink::open_blocking_with(options)?)),
            _ => {}
        }
        runtime.block_on(async {
            Ok(match id {
                "scl-pub" => Self::SclPub(Sink::open_with(options).await?),
                "scl-push" => Self::SclPush(Sink::open_with(options).await?),
                "zeromq-pub" => Self::ZeromqPub(paths.connect_sub("stream").await?),
                "zeromq-push" => {
                    let mut socket = PullSocket::new();
                    socket.bind(&paths.endpoint("stream")).await?;
                    print_line("listening")?;
                    Self::ZeromqPush(socket)
                }
                #[cfg(feature = "libzmq")]
                "libzmq-nodrop" | "libzmq-pub" | "libzmq-push" | "libzmq-push-unlimited" => {
                    Self::Libzmq(connect_libzmq(&paths, id)?)
                }
                "unix" => Self::Unix(UnixStream::connect(paths.path("stream")).await?, FrameBuffer::new(bytes)),
                other => return Err(unknown_arguments(&[other])),
            })
        })
    }

    fn receive_batch(&mut self, runtime: &Runtime, batch: &mut Batch) -> scl::Result<()> {
        match self {
            Self::Other(receiver) => receiver.receive_batch(runtime, batch),
            Self::SclPubBlocking(sink) => {
                while !batch.is_complete() {
                    batch.add(&sink.stream.recv_blocking()?)?;
                }
                Ok(())
            }
            Self::SclPushBlocking(sink) => {
                while !batch.is_complete() {
                    batch.add(&sink.jobs.recv_blocking()?)?;
                }
                Ok(())
            }
            _ => runtime.block_on(async {
                while !batch.is_complete() {
                    self.receive(batch).await?;
                }
                Ok(())
            }),
        }
    }

    async fn receive(&mut self, batch: &mut Batch) -> scl::Result<()> {
        match self {
            Self::SclPub(sink) => batch.add(&sink.stream.recv().await?),
            Self::SclPush(sink) => batch.add(&sink.jobs.recv().await?),
            Self::ZeromqPub(socket) => batch.add(&first_frame(socket.recv().await?)),
            Self::ZeromqPush(socket) => batch.add(&first_frame(socket.recv().await?)),
            #[cfg(feature = "libzmq")]
            Self::Libzmq(socket) => batch.add(&socket.recv_msg(0)?),
            Self::Unix(stream, frames) => batch.add(&frames.read(stream).await?[PREFIX..]),
            Self::SclPubBlocking(_) | Self::SclPushBlocking(_) | Self::Other(_) => {
                Err(scl::Error::message("this variant receives whole batches only"))
            }
        }
    }
}

#[cfg(feature = "libzmq")]
fn connect_libzmq(paths: &SocketPaths, id: &str) -> scl::Result<zmq2::Socket> {
    use crate::libzmq::{HighWaterMark, without_timeout};
    let (kind, mark) = match id {
        "libzmq-nodrop" => (zmq2::SUB, HighWaterMark::Default),
        "libzmq-pub" => (zmq2::SUB, HighWaterMark::Unlimited),
        "libzmq-push" => (zmq2::PULL, HighWaterMark::Default),
        _ => (zmq2::PULL, HighWaterMark::Unlimited),
    };
    without_timeout(paths.connect_libzmq(&zmq2::Context::new(), "stream", kind, mark)?)
}
