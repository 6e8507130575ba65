//! The side whose allocations are counted.

use super::components;
use super::reading::Reading;
use crate::raw::SocketPaths;
use crate::unix::{FrameBuffer, zeroed_frame};
use crate::worker::unknown_arguments;
use std::io::Write;
use std::os::unix::net::UnixStream as StdUnixStream;
use std::time::Duration;
use tokio::io::AsyncWriteExt;
use tokio::net::UnixStream;
use tokio::runtime::Runtime;

const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

/// One role, async or blocking.
pub(super) struct Near {
    role: &'static str,
    connection: Connection,
}

enum Connection {
    Async(components::Near),
    Blocking(components::Near),
    AsyncUnix(UnixStream, Frames),
    BlockingUnix(StdUnixStream, Frames),
}

struct Frames {
    sent: Vec<u8>,
    received: FrameBuffer,
}

impl Near {
    pub(super) fn open(runtime: &Runtime, role: &'static str, is_blocking: bool, folder: &str) -> scl::Result<Self> {
        let options = scl::OpenOptions::new().runtime_dir(folder).system("allocations");
        let connection = match (role, is_blocking) {
            ("unix", is_blocking) => open_unix(runtime, is_blocking, folder)?,
            (_, false) => {
                let near = runtime.block_on(components::Near::open_with(options))?;
                runtime.block_on(near.ready(CONNECT_TIMEOUT))?;
                Connection::Async(near)
            }
            (_, true) => {
                let near = components::Near::open_blocking_with(options)?;
                near.ready_blocking(CONNECT_TIMEOUT)?;
                Connection::Blocking(near)
            }
        };
        Ok(Self { role, connection })
    }

    /// Plays the role for a number of messages.
    pub(super) fn exchange(&mut self, runtime: &Runtime, messages: usize) -> scl::Result<()> {
        let role = self.role;
        match &mut self.connection {
            Connection::Async(near) => runtime.block_on(exchange(near, role, messages)),
            Connection::Blocking(near) => exchange_blocking(near, role, messages),
            Connection::AsyncUnix(stream, frames) => runtime.block_on(async {
                for _ in 0..messages {
                    stream.write_all(&frames.sent).await?;
                    frames.received.read(stream).await?;
                }
                Ok(())
            }),
            Connection::BlockingUnix(stream, frames) => {
                for _ in 0..messages {
                    stream.write_all(&frames.sent)?;
                    frames.received.read_blocking(stream)?;
                }
                Ok(())
            }
        }
    }
}

async fn exchange(near: &mut components::Near, role: &str, messages: usize) -> scl::Result<()> {
    let reading = Reading::default();
    for _ in 0..messages {
        match role {
            "publish" => near.publish.send(&reading).await?,
            "subscribe" => {
                near.subscribe.recv().await?;
            }
            "push" => near.push.send(&reading).await?,
            "pull" => {
                near.pull.recv().await?;
            }
            "request" => {
                near.request.call(&reading).await?;
            }
            "reply" => near.reply.recv().await?.reply(&reading)?,
            "publish-and-subscribe" => {
                near.publish.send(&reading).await?;
                near.subscribe.recv().await?;
            }
            other => return Err(unknown_arguments(&[other])),
        }
    }
    Ok(())
}

fn exchange_blocking(near: &mut components::Near, role: &str, messages: usize) -> scl::Result<()> {
    let reading = Reading::default();
    for _ in 0..messages {
        match role {
            "publish" => near.publish.send_blocking(&reading)?,
            "subscribe" => {
                near.subscribe.recv_blocking()?;
            }
            "push" => near.push.send_blocking(&reading)?,
            "pull" => {
                near.pull.recv_blocking()?;
            }
            "request" => {
                near.request.call_blocking(&reading)?;
            }
            "reply" => near.reply.recv_blocking()?.reply(&reading)?,
            "publish-and-subscribe" => {
                near.publish.send_blocking(&reading)?;
                near.subscribe.recv_blocking()?;
            }
            other => return Err(unknown_arguments(&[other])),
        }
    }
    Ok(())
}

fn open_unix(runtime: &Runtime, is_blocking: bool, folder: &str) -> scl::Result<Connection> {
    let path = SocketPaths::new(folder, "unix").path("stream");
    let frames = Frames { sent: zeroed_frame(size_of::<Reading>())?, received: FrameBuffer::new(size_of::<Reading>()) };
    if is_blocking {
        let listener = std::os::unix::net::UnixListener::bind(path)?;
        return Ok(Connection::BlockingUnix(listener.accept()?.0, frames));
    }
    let listener = {
        let _runtime = runtime.enter();
        tokio::net::UnixListener::bind(path)?
    };
    Ok(Connection::AsyncUnix(runtime.block_on(listener.accept())?.0, frames))
}
