//! The side that is restarted, a worker process.

use super::PERIOD;
use super::components::{Publisher, Puller, Pusher, Replier, Requester, Subscriber};
use crate::clock::now;
use crate::raw::SocketPaths;
use crate::runtime::start_runtime;
use crate::worker::{print_line, unknown_arguments};
use scl::bytes::Bytes;
use scl::time::interval;
use std::future::pending;
use tokio::io::AsyncWriteExt;
use tokio::net::UnixStream;
use zeromq::SocketRecv;

/// Sends messages with the number of this run, or prints the time of the first message it receives, until it is killed.
/// The arguments are the variant's id, the scratch folder and the number of the run.
pub(crate) fn run_restarted(arguments: &[&str]) -> scl::Result<()> {
    let [id, folder, run] = arguments else { return Err(unknown_arguments(arguments)) };
    let message = Bytes::copy_from_slice(&run.parse::<u32>()?.to_be_bytes());
    let options = scl::OpenOptions::new().runtime_dir(*folder).system(*id);
    let paths = SocketPaths::new(folder, id);
    start_runtime()?.block_on(async {
        let mut interval = interval(PERIOD)?;
        match *id {
            "scl-publisher" => {
                let mut publisher = Publisher::open_with(options).await?;
                loop {
                    publisher.stream.send(&message).await?;
                    interval.tick().await?;
                }
            }
            "scl-pusher" => {
                let mut pusher = Pusher::open_with(options).await?;
                loop {
                    pusher.stream.send(&message).await?;
                    interval.tick().await?;
                }
            }
            "scl-replier" => {
                let mut replier = Replier::open_with(options).await?;
                loop {
                    replier.stream.recv().await?.reply(&message)?;
                }
            }
            "scl-subscriber" => {
                let mut subscriber = Subscriber::open_with(options).await?;
                subscriber.stream.recv().await?;
                report_first(subscriber).await
            }
            "scl-puller" => {
                let mut puller = Puller::open_with(options).await?;
                puller.stream.recv().await?;
                report_first(puller).await
            }
            "scl-requester" => {
                let mut requester = Requester::open_with(options).await?;
                requester.stream.call(&message).await?;
                report_first(requester).await
            }
            "zeromq-subscriber" => {
                let mut socket = paths.connect_sub("stream").await?;
                socket.recv().await?;
                report_first(socket).await
            }
            #[cfg(feature = "libzmq")]
            "libzmq-publisher" => {
                let mark = crate::libzmq::HighWaterMark::Default;
                let socket = paths.bind_libzmq(&zmq2::Context::new(), "stream", zmq2::PUB, mark)?;
                loop {
                    socket.send(&message[..], 0)?;
                    interval.tick().await?;
                }
            }
            #[cfg(feature = "libzmq")]
            "libzmq-subscriber" => {
                let mark = crate::libzmq::HighWaterMark::Default;
                let socket = paths.connect_libzmq(&zmq2::Context::new(), "stream", zmq2::SUB, mark)?;
                socket.recv_bytes(0)?;
                report_first(socket).await
            }
            "unix" => {
                let mut stream = UnixStream::connect(paths.path("stream")).await?;
                stream.write_u8(0).await?;
                pending().await
            }
            _ => Err(unknown_arguments(arguments)),
        }
    })
}

/// Reports that the first message has arrived, and keeps the connection until this process is killed.
async fn report_first<T>(connection: T) -> scl::Result<()> {
    print_line(&now().to_string())?;
    pending::<()>().await;
    drop(connection);
    Ok(())
}
