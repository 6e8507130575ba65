//! The subscriber processes.

use super::message::Message;
use crate::clock::now;
use crate::components::fanout::{
    Subscriber1, Subscriber2, Subscriber3, Subscriber4, Subscriber5, Subscriber6, Subscriber7, Subscriber8,
};
use crate::ends::Receiver;
use crate::one_way::BatchReport;
use crate::raw::SocketPaths;
use crate::runtime::start_runtime;
use crate::worker::{print_line, unknown_arguments};
use rustix::process::{Signal, set_parent_process_death_signal};
use scl::Sub;
use scl::bytes::Bytes;

/// Receives forever, and reports each batch when its last message has arrived. The arguments are the variant's id, the
/// scratch folder and the number of the subscriber.
pub(crate) fn run_subscriber(arguments: &[&str]) -> scl::Result<()> {
    let [id, folder, number] = arguments else { return Err(unknown_arguments(arguments)) };
    // While it is stopped by SIGSTOP, this process cannot notice that its standard input was closed.
    set_parent_process_death_signal(Some(Signal::KILL))?;
    start_runtime()?.block_on(async {
        let mut socket = open(id, folder, number).await?;
        let (mut batch, mut delays) = (0, Vec::new());
        loop {
            let message = Message::decode(&socket.receive().await?.payload())?;
            if message.batch != batch {
                batch = message.batch;
                delays.clear();
            }
            delays.push(now().saturating_sub(message.sent));
            if message.remaining == 0 {
                print_line(&BatchReport { span: batch.into(), delays: std::mem::take(&mut delays) }.to_line())?;
            }
        }
    })
}

async fn open(id: &str, folder: &str, number: &str) -> scl::Result<Receiver> {
    match id {
        "scl" => {
            let options = scl::OpenOptions::new().runtime_dir(folder).system(id);
            Ok(Receiver::Sub(open_gate(number, options).await?, false))
        }
        "zeromq" => Ok(Receiver::Zeromq(Box::new(SocketPaths::new(folder, id).connect_sub("stream").await?))),
        other => Err(unknown_arguments(&[other])),
    }
}

async fn open_gate(number: &str, options: scl::OpenOptions) -> scl::Result<Sub<Bytes>> {
    Ok(match number {
        "1" => Subscriber1::open_with(options).await?.stream,
        "2" => Subscriber2::open_with(options).await?.stream,
        "3" => Subscriber3::open_with(options).await?.stream,
        "4" => Subscriber4::open_with(options).await?.stream,
        "5" => Subscriber5::open_with(options).await?.stream,
        "6" => Subscriber6::open_with(options).await?.stream,
        "7" => Subscriber7::open_with(options).await?.stream,
        "8" => Subscriber8::open_with(options).await?.stream,
        other => return Err(unknown_arguments(&[other])),
    })
}
