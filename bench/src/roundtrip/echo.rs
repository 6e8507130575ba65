//! The side that sends everything back.

use crate::components::roundtrip::Replier;
use crate::engines::{FAR, options};
use crate::link::{Far, Setup, open};
use crate::raw::SocketPaths;
use crate::runtime::{run, start_runtime};
use crate::worker::{print_line, unknown_arguments};
use zeromq::{RouterSocket, SocketRecv, SocketSend};

/// Runs the echo process of a variant. The arguments are its id, the scratch folder and the message size.
pub(crate) fn run_echo(arguments: &[&str]) -> scl::Result<()> {
    let [id, folder, bytes] = *arguments else { return Err(unknown_arguments(arguments)) };
    let bytes = bytes.parse()?;
    let paths = SocketPaths::new(folder, id);
    let is_blocking = id.ends_with("-blocking");
    run(&start_runtime()?, id, async {
        match id {
            "scl-req" | "scl-req-blocking" => {
                let mut replier = open!(Replier, options(id, folder, FAR), is_blocking);
                print_line("open")?;
                loop {
                    let request = match is_blocking {
                        true => replier.request.recv_blocking()?,
                        false => replier.request.recv().await?,
                    };
                    let reply = request.message().clone();
                    request.reply(&reply)?;
                }
            }
            "zeromq-req" => {
                let mut router: RouterSocket = paths.bind("request").await?;
                print_line("open")?;
                loop {
                    let request = router.recv().await?;
                    router.send(request).await?;
                }
            }
            #[cfg(feature = "libzmq")]
            "libzmq-req-blocking" => {
                let socket = paths.connect_libzmq("request", zmq2::REP, crate::libzmq::HighWaterMark::Default)?;
                socket.set_rcvtimeo(-1)?;
                print_line("open")?;
                loop {
                    socket.send(socket.recv_msg(0)?, 0)?;
                }
            }
            _ => {
                let mut far = Far::open(Setup { id, folder, bytes, is_round_trip: true, batch: 0 }).await?;
                let (receiver, sender) = far.both()?;
                loop {
                    sender.send_back(receiver.receive().await?).await?;
                }
            }
        }
    })
}
