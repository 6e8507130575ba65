//! The side that is restarted, a worker process.

use super::PERIOD;
use super::side::Side;
use crate::clock::now;
use crate::raw::SocketPaths;
use crate::runtime::start_runtime;
use crate::worker::{print_line, unknown_arguments};
use scl::bytes::Bytes;
use scl::time::interval;
use std::future::pending;
use tokio::io::AsyncWriteExt;
use tokio::net::UnixStream;

/// Sends messages with the number of this run, or prints the time of the first message it receives, until it is killed.
/// The arguments are the variant's id, the scratch folder and the number of the run.
pub(crate) fn run_restarted(arguments: &[&str]) -> scl::Result<()> {
    let [id, folder, run] = *arguments else { return Err(unknown_arguments(arguments)) };
    let message = Bytes::copy_from_slice(&run.parse::<u32>()?.to_be_bytes());
    start_runtime()?.block_on(async {
        if id == "unix" {
            let mut stream = UnixStream::connect(SocketPaths::new(folder, id).path("stream")).await?;
            stream.write_u8(0).await?;
            return pending().await;
        }
        let mut side = Side::open(id, true, folder).await?;
        match &mut side {
            Side::Sends(sender) => {
                let mut interval = interval(PERIOD)?;
                loop {
                    sender.send(&message.clone().into()).await?;
                    interval.tick().await?;
                }
            }
            Side::Replies(gate) => loop {
                gate.recv().await?.reply(&message)?;
            },
            Side::Receives(receiver) => drop(receiver.receive().await?),
            Side::Calls(gate) => drop(gate.call(&message).await?),
        }
        // Keep the connection open until this process is killed.
        print_line(&now().to_string())?;
        pending().await
    })
}
