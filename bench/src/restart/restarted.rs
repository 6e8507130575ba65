//! The side that is restarted, a worker process.

use super::PERIOD;
use crate::clock::now;
use crate::components::restart::{Publisher, Puller, Pusher, Replier, Requester, Subscriber};
use crate::link::open;
use crate::message::Frame;
use crate::raw::SocketPaths;
use crate::receiver::Receiver;
use crate::runtime::start_runtime;
use crate::sender::{Calls, Sender};
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
    let options = scl::OpenOptions::new().runtime_dir(folder).system(id);
    let paths = SocketPaths::new(folder, id);
    start_runtime()?.block_on(async {
        match id {
            "scl-publisher" => {
                send_forever(Sender::Pub(open!(Publisher, options, false).stream, Calls::default()), message).await
            }
            "scl-pusher" => {
                send_forever(Sender::Push(open!(Pusher, options, false).stream, Calls::default()), message).await
            }
            "scl-replier" => {
                let mut replier = open!(Replier, options, false);
                loop {
                    replier.stream.recv().await?.reply(&message)?;
                }
            }
            "scl-subscriber" => report_first(Receiver::Sub(open!(Subscriber, options, false).stream, false)).await,
            "scl-puller" => report_first(Receiver::Pull(open!(Puller, options, false).stream, false)).await,
            "scl-requester" => {
                let mut requester = open!(Requester, options, false);
                requester.stream.call(&message).await?;
                print_line(&now().to_string())?;
                pending::<()>().await;
                drop(requester);
                Ok(())
            }
            "zeromq-subscriber" => report_first(Receiver::Zeromq(Box::new(paths.connect_sub("stream").await?))).await,
            #[cfg(feature = "libzmq")]
            "libzmq-publisher" => {
                let mark = crate::libzmq::HighWaterMark::Default;
                send_forever(Sender::Libzmq(paths.bind_libzmq("stream", zmq2::PUB, mark)?), message).await
            }
            #[cfg(feature = "libzmq")]
            "libzmq-subscriber" => {
                let mark = crate::libzmq::HighWaterMark::Default;
                report_first(Receiver::Libzmq(paths.connect_libzmq("stream", zmq2::SUB, mark)?)).await
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

async fn send_forever(mut sender: Sender, message: Bytes) -> scl::Result<()> {
    let mut interval = interval(PERIOD)?;
    loop {
        sender.send(Frame::Bytes(message.clone())).await?;
        interval.tick().await?;
    }
}

/// Reports when the first message arrives, and keeps the connection until this process is killed.
async fn report_first(mut receiver: Receiver) -> scl::Result<()> {
    receiver.receive().await?;
    print_line(&now().to_string())?;
    pending::<()>().await;
    drop(receiver);
    Ok(())
}
