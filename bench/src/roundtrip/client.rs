//! The side that sends first, and measures.

use super::batch_client::BatchClient;
use super::components;
use crate::raw::SocketPaths;
use crate::unix::{FrameBuffer, zeroed_frame};
use crate::worker::{Worker, unknown_arguments};
use scl::bytes::Bytes;
use std::io::Write;
use std::os::unix::net::{UnixListener as StdUnixListener, UnixStream as StdUnixStream};
use std::time::{Duration, Instant};
use tokio::io::AsyncWriteExt;
use tokio::net::{UnixListener, UnixStream};
use tokio::runtime::Runtime;
use zeromq::{DealerSocket, Socket, SocketRecv, SocketSend, SubSocket, XPubSocket, ZmqMessage};

const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

/// The client of one variant.
pub(super) enum Client {
    Async(AsyncClient),
    Blocking(BlockingClient),
    /// A client of another transport or library.
    Other(Box<dyn BatchClient>),
}

/// A client that runs on the async runtime.
pub(super) enum AsyncClient {
    SclPub(components::Client),
    SclReq(components::Client),
    ZeromqPub { ping: XPubSocket, pong: SubSocket },
    ZeromqReq(DealerSocket),
    Unix { stream: UnixStream, frame: Vec<u8>, received: FrameBuffer },
}

/// A client that runs on a plain thread.
pub(super) enum BlockingClient {
    SclPub(components::Client),
    SclReq(components::Client),
    #[cfg(feature = "libzmq")]
    Libzmq(super::libzmq::Client),
    Unix {
        stream: StdUnixStream,
        frame: Vec<u8>,
        received: FrameBuffer,
    },
}

impl Client {
    /// Starts the echo process of a variant and connects to it.
    pub(super) fn start(runtime: &Runtime, id: &str, folder: &str, bytes: usize) -> scl::Result<(Self, Worker)> {
        let echo = ["roundtrip", id, folder, &bytes.to_string()];
        let other = match id {
            "ipc" | "ipc-blocking" | "tcp" => Some(super::engines::start(runtime, id, folder, &echo)?),
            #[cfg(feature = "shm")]
            "shm-loan" | "shm-loan-blocking" | "shm-copy" | "shm-copy-blocking" => {
                Some(super::engines::start(runtime, id, folder, &echo)?)
            }
            #[cfg(feature = "shm")]
            "iceoryx-loan" | "iceoryx-copy" => Some(super::iceoryx::start(runtime, id, folder, bytes, &echo)?),
            #[cfg(feature = "gateway")]
            "gateway" => Some(super::engines::start_across_hosts(runtime, folder, &echo)?),
            #[cfg(feature = "gateway")]
            "zenoh" => Some(super::zenoh::start(runtime, &echo)?),
            _ => None,
        };
        if let Some((client, echo)) = other {
            return Ok((Self::Other(client), echo));
        }
        if id.ends_with("-blocking") {
            let (client, echo) = BlockingClient::start(id, folder, bytes, &echo)?;
            return Ok((Self::Blocking(client), echo));
        }
        let (client, echo) = runtime.block_on(AsyncClient::start(id, folder, bytes, &echo))?;
        Ok((Self::Async(client), echo))
    }

    /// Sends messages one after the other, each when the previous one has returned, and replaces the contents of
    /// `durations` by the round-trip times in nanoseconds.
    pub(super) fn exchange(
        &mut self,
        runtime: &Runtime,
        payload: &Bytes,
        messages: usize,
        durations: &mut Vec<u64>,
    ) -> scl::Result<()> {
        durations.clear();
        let mut record = |started: Instant| durations.push(started.elapsed().as_nanos().try_into().unwrap_or(u64::MAX));
        match self {
            Self::Other(client) => client.exchange(runtime, payload, messages, &mut record),
            Self::Async(client) => runtime.block_on(async {
                for _ in 0..messages {
                    let started = Instant::now();
                    client.exchange(payload).await?;
                    record(started);
                }
                Ok(())
            }),
            Self::Blocking(client) => {
                for _ in 0..messages {
                    let started = Instant::now();
                    client.exchange(payload)?;
                    record(started);
                }
                Ok(())
            }
        }
    }
}

impl AsyncClient {
    async fn start(id: &str, folder: &str, bytes: usize, echo: &[&str]) -> scl::Result<(Self, Worker)> {
        let paths = SocketPaths::new(folder, id);
        match id {
            "scl-pub" | "scl-req" => {
                let echo = Worker::start(echo)?;
                let options = scl::OpenOptions::new().runtime_dir(folder).system(id);
                let client = components::Client::open_with(options).await?;
                client.ready(CONNECT_TIMEOUT).await?;
                Ok((if id == "scl-req" { Self::SclReq(client) } else { Self::SclPub(client) }, echo))
            }
            "zeromq-pub" => {
                let mut ping = paths.bind_xpub("ping").await?;
                let mut echo = Worker::start(echo)?;
                let _listening = echo.next_line().await?;
                let pong = paths.connect_sub("pong").await?;
                let _subscription = ping.recv().await?;
                Ok((Self::ZeromqPub { ping, pong }, echo))
            }
            "zeromq-req" => {
                let mut echo = Worker::start(echo)?;
                let _listening = echo.next_line().await?;
                let mut dealer = DealerSocket::new();
                dealer.connect(&paths.endpoint("request")).await?;
                Ok((Self::ZeromqReq(dealer), echo))
            }
            "unix" => {
                let listener = UnixListener::bind(paths.path("stream"))?;
                let echo = Worker::start(echo)?;
                let (stream, _) = listener.accept().await?;
                Ok((Self::Unix { stream, frame: zeroed_frame(bytes)?, received: FrameBuffer::new(bytes) }, echo))
            }
            other => Err(unknown_arguments(&[other])),
        }
    }

    async fn exchange(&mut self, payload: &Bytes) -> scl::Result<()> {
        match self {
            Self::SclPub(client) => {
                client.ping.send(payload).await?;
                client.pong.recv().await?;
            }
            Self::SclReq(client) => drop(client.request.call(payload).await?),
            Self::ZeromqPub { ping, pong } => {
                ping.send(payload.clone().into()).await?;
                pong.recv().await?;
            }
            Self::ZeromqReq(dealer) => {
                dealer.send(as_request(payload)).await?;
                dealer.recv().await?;
            }
            Self::Unix { stream, frame, received } => {
                stream.write_all(frame).await?;
                received.read(stream).await?;
            }
        }
        Ok(())
    }
}

impl BlockingClient {
    fn start(id: &str, folder: &str, bytes: usize, echo: &[&str]) -> scl::Result<(Self, Worker)> {
        match id {
            "scl-pub-blocking" | "scl-req-blocking" => {
                let echo = Worker::start(echo)?;
                let options = scl::OpenOptions::new().runtime_dir(folder).system(id);
                let client = components::Client::open_blocking_with(options)?;
                client.ready_blocking(CONNECT_TIMEOUT)?;
                Ok((if id == "scl-req-blocking" { Self::SclReq(client) } else { Self::SclPub(client) }, echo))
            }
            #[cfg(feature = "libzmq")]
            "libzmq-pub-blocking" | "libzmq-req-blocking" => {
                let (client, echo) = super::libzmq::Client::start(id, folder, echo)?;
                Ok((Self::Libzmq(client), echo))
            }
            "unix-blocking" => {
                let listener = StdUnixListener::bind(SocketPaths::new(folder, id).path("stream"))?;
                let echo = Worker::start(echo)?;
                let (stream, _) = listener.accept()?;
                Ok((Self::Unix { stream, frame: zeroed_frame(bytes)?, received: FrameBuffer::new(bytes) }, echo))
            }
            other => Err(unknown_arguments(&[other])),
        }
    }

    fn exchange(&mut self, payload: &Bytes) -> scl::Result<()> {
        match self {
            Self::SclPub(client) => {
                client.ping.send_blocking(payload)?;
                client.pong.recv_blocking()?;
            }
            Self::SclReq(client) => drop(client.request.call_blocking(payload)?),
            #[cfg(feature = "libzmq")]
            Self::Libzmq(client) => client.exchange(payload)?,
            Self::Unix { stream, frame, received } => {
                stream.write_all(frame)?;
                received.read_blocking(stream)?;
            }
        }
        Ok(())
    }
}

/// A message as a REQ socket sends it, after an empty frame.
fn as_request(payload: &Bytes) -> ZmqMessage {
    let mut request = ZmqMessage::from(Bytes::new());
    request.push_back(payload.clone());
    request
}
