//! The side that sends everything back.

use super::components::Echo;
use crate::raw::SocketPaths;
use crate::runtime::start_runtime;
use crate::unix::{echo, echo_blocking};
use crate::worker::{print_line, unknown_arguments};
use std::os::unix::net::UnixStream as StdUnixStream;
use tokio::net::UnixStream;
use zeromq::{RouterSocket, Socket, SocketRecv, SocketSend};

/// Runs the echo process of a variant. The arguments are its id, the scratch folder and the message size.
pub(crate) fn run_echo(arguments: &[&str]) -> scl::Result<()> {
    let [id, folder, bytes, rest @ ..] = arguments else { return Err(unknown_arguments(arguments)) };
    #[cfg(not(feature = "gateway"))]
    let _only_for_gateway = rest;
    let bytes: usize = bytes.parse()?;
    let paths = SocketPaths::new(folder, id);
    let options = scl::OpenOptions::new().runtime_dir(*folder).system(*id);
    let runtime = start_runtime()?;
    match *id {
        "ipc" | "tcp" | "gateway" | "shm-loan" | "shm-copy" => runtime.block_on(super::engines::echo(id, folder)),
        "ipc-blocking" | "shm-loan-blocking" | "shm-copy-blocking" => super::engines::echo_blocking(id, folder),
        #[cfg(feature = "shm")]
        "iceoryx-loan" | "iceoryx-copy" => super::iceoryx::echo(id, folder, bytes),
        #[cfg(feature = "gateway")]
        "zenoh" => super::zenoh::echo(rest.first().ok_or_else(|| unknown_arguments(arguments))?),
        "scl-pub" => runtime.block_on(scl_pub(options)),
        "scl-req" => runtime.block_on(scl_req(options)),
        "scl-pub-blocking" => scl_pub_blocking(options),
        "scl-req-blocking" => scl_req_blocking(options),
        "zeromq-pub" => runtime.block_on(zeromq_pub(&paths)),
        "zeromq-req" => runtime.block_on(zeromq_req(&paths)),
        #[cfg(feature = "libzmq")]
        "libzmq-pub-blocking" => super::libzmq::echo_published(&paths),
        #[cfg(feature = "libzmq")]
        "libzmq-req-blocking" => super::libzmq::echo_requests(&paths),
        "unix" => runtime.block_on(async { echo(UnixStream::connect(paths.path("stream")).await?, bytes).await }),
        "unix-blocking" => echo_blocking(StdUnixStream::connect(paths.path("stream"))?, bytes),
        _ => Err(unknown_arguments(arguments)),
    }
}

async fn scl_pub(options: scl::OpenOptions) -> scl::Result<()> {
    let mut echo = Echo::open_with(options).await?;
    loop {
        let message = echo.ping.recv().await?;
        echo.pong.send(&message).await?;
    }
}

async fn scl_req(options: scl::OpenOptions) -> scl::Result<()> {
    let mut echo = Echo::open_with(options).await?;
    loop {
        let request = echo.request.recv().await?;
        let reply = request.message().clone();
        request.reply(&reply)?;
    }
}

fn scl_pub_blocking(options: scl::OpenOptions) -> scl::Result<()> {
    let mut echo = Echo::open_blocking_with(options)?;
    loop {
        let message = echo.ping.recv_blocking()?;
        echo.pong.send_blocking(&message)?;
    }
}

fn scl_req_blocking(options: scl::OpenOptions) -> scl::Result<()> {
    let mut echo = Echo::open_blocking_with(options)?;
    loop {
        let request = echo.request.recv_blocking()?;
        let reply = request.message().clone();
        request.reply(&reply)?;
    }
}

async fn zeromq_pub(paths: &SocketPaths) -> scl::Result<()> {
    let mut pong = paths.bind_xpub("pong").await?;
    print_line("listening")?;
    let mut ping = paths.connect_sub("ping").await?;
    let _subscription = pong.recv().await?;
    loop {
        let message = ping.recv().await?;
        pong.send(message).await?;
    }
}

async fn zeromq_req(paths: &SocketPaths) -> scl::Result<()> {
    let mut router = RouterSocket::new();
    router.bind(&paths.endpoint("request")).await?;
    print_line("listening")?;
    loop {
        let request = router.recv().await?;
        router.send(request).await?;
    }
}
