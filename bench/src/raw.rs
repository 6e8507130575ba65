//! The raw parts: sockets of the `zeromq` library and of the operating system, without SCL.

use scl::bytes::Bytes;
use std::io::{Read, Write};
use std::os::unix::net::UnixStream as StdUnixStream;
use std::path::{Path, PathBuf};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::UnixStream;
use zeromq::{Socket, SubSocket, XPubSocket, ZmqMessage};

/// Where the raw sockets of a scenario lie.
#[derive(Debug, Clone)]
pub(crate) struct RawPlace(PathBuf);

impl RawPlace {
    /// A place of its own for each `name` in a scenario's folder.
    pub(crate) fn new(folder: &str, name: &str) -> Self {
        Self(Path::new(folder).join("raw").join(name))
    }

    pub(crate) fn socket(&self, end: &str) -> PathBuf {
        self.0.with_extension(end)
    }

    pub(crate) fn zeromq(&self, end: &str) -> String {
        format!("ipc://{}", self.socket(end).display())
    }

    pub(crate) async fn publish(&self, end: &str) -> scl::Result<XPubSocket> {
        let mut socket = XPubSocket::new();
        socket.bind(&self.zeromq(end)).await?;
        Ok(socket)
    }

    pub(crate) async fn subscribe(&self, end: &str) -> scl::Result<SubSocket> {
        let mut socket = SubSocket::new();
        socket.connect(&self.zeromq(end)).await?;
        socket.subscribe("").await?;
        Ok(socket)
    }
}

/// A request as a REQ socket would send it.
pub(crate) fn question(payload: &Bytes) -> ZmqMessage {
    let mut question = ZmqMessage::from(Bytes::new());
    question.push_back(payload.clone());
    question
}

/// The only frame of a message.
pub(crate) fn only_frame(message: ZmqMessage) -> Bytes {
    message.into_vecdeque().pop_front().unwrap_or_default()
}

/// A message of known length there and back, or back and there.
pub(crate) async fn exchange(stream: &mut UnixStream, payload: &[u8], answer: &mut [u8]) -> std::io::Result<()> {
    stream.write_all(payload).await?;
    stream.read_exact(answer).await?;
    Ok(())
}

pub(crate) async fn send_back(mut stream: UnixStream, bytes: usize) -> scl::Result<()> {
    let mut message = vec![0; bytes];
    loop {
        stream.read_exact(&mut message).await?;
        stream.write_all(&message).await?;
    }
}

pub(crate) fn exchange_blocking(stream: &mut StdUnixStream, payload: &[u8], answer: &mut [u8]) -> std::io::Result<()> {
    stream.write_all(payload)?;
    stream.read_exact(answer)
}

pub(crate) fn send_back_blocking(mut stream: StdUnixStream, bytes: usize) -> scl::Result<()> {
    let mut message = vec![0; bytes];
    loop {
        stream.read_exact(&mut message)?;
        stream.write_all(&message)?;
    }
}
