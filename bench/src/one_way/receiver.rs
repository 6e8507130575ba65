//! The side that receives.

use super::components::Sink;
use super::{Received, SHORTEST};
use crate::clock::now;
use crate::processes::{say, start_runtime, wrong_words};
use crate::raw::{RawPlace, only_frame};
use scl::bytes::{Buf, Bytes, BytesMut};
use tokio::io::AsyncReadExt;
use tokio::net::UnixStream;
use zeromq::{PullSocket, Socket, SocketRecv, SubSocket};

/// Receives for ever on the way that the words name, with the scenario's folder, the messages' length and the size of a
/// batch.
pub(crate) fn play_receiver(words: &[&str]) -> scl::Result<()> {
    let [word, folder, bytes, batch] = words else { return Err(wrong_words(words)) };
    let (bytes, batch) = (bytes.parse()?, batch.parse()?);
    start_runtime()?.block_on(async {
        let mut receiver = Receiver::open(word, folder, bytes).await?;
        loop {
            say(&receiver.receive_batch(batch).await?.to_line())?;
        }
    })
}

/// The receiving end of a way.
enum Receiver {
    SclPublish(Sink),
    SclPush(Sink),
    RawPublish(SubSocket),
    RawPush(PullSocket),
    #[cfg(feature = "libzmq")]
    Libzmq(zmq2::Socket),
    Unix(UnixStream, BytesMut),
}

impl Receiver {
    async fn open(word: &str, folder: &str, bytes: usize) -> scl::Result<Self> {
        let place = RawPlace::new(folder, word);
        let open_sink = || Sink::open_with(scl::OpenOptions::new().runtime_dir(folder).system(word));
        Ok(match word {
            "scl-publish" => Self::SclPublish(open_sink().await?),
            "scl-push" => Self::SclPush(open_sink().await?),
            "raw-publish" => Self::RawPublish(place.subscribe("stream").await?),
            "raw-push" => {
                let mut socket = PullSocket::new();
                socket.bind(&place.zeromq("stream")).await?;
                say("ready")?;
                Self::RawPush(socket)
            }
            #[cfg(feature = "libzmq")]
            "libzmq-publish" => Self::Libzmq(endless(place.subscribe_libzmq(&zmq2::Context::new(), "stream")?)?),
            #[cfg(feature = "libzmq")]
            "libzmq-push" => Self::Libzmq(endless(place.bind_libzmq(&zmq2::Context::new(), zmq2::PULL, "stream")?)?),
            "unix" => {
                Self::Unix(UnixStream::connect(place.socket("stream")).await?, BytesMut::zeroed(bytes.max(SHORTEST)))
            }
            other => return Err(wrong_words(&[other])),
        })
    }

    async fn receive_batch(&mut self, batch: usize) -> scl::Result<Received> {
        let mut delays = Vec::with_capacity(batch);
        let (mut first, mut last) = (0, 0);
        for index in 0..batch {
            let sent = self.receive().await?.try_get_u64()?;
            last = now();
            if index == 0 {
                // A sender that takes in everything before it writes anything is not faster than one that writes at once.
                first = sent;
            }
            delays.push(last.saturating_sub(sent));
        }
        Ok(Received { span: last.saturating_sub(first), delays })
    }

    async fn receive(&mut self) -> scl::Result<Bytes> {
        Ok(match self {
            Self::SclPublish(sink) => sink.stream.recv().await?,
            Self::SclPush(sink) => sink.jobs.recv().await?,
            Self::RawPublish(socket) => only_frame(socket.recv().await?),
            Self::RawPush(socket) => only_frame(socket.recv().await?),
            #[cfg(feature = "libzmq")]
            Self::Libzmq(socket) => socket.recv_bytes(0)?.into(),
            Self::Unix(stream, buffer) => {
                stream.read_exact(buffer).await?;
                Bytes::copy_from_slice(buffer)
            }
        })
    }
}

/// Waits for a message as long as it takes: between two batches others have their turn.
#[cfg(feature = "libzmq")]
fn endless(socket: zmq2::Socket) -> scl::Result<zmq2::Socket> {
    socket.set_rcvtimeo(-1)?;
    Ok(socket)
}
