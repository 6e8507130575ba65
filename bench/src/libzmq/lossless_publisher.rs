//! Starts the publisher with `ZMQ_XPUB_NODROP`, a C++ program because `zmq2` has no setter for this option.

use crate::raw::SocketPaths;
use crate::worker::Worker;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;

/// The program, compiled by the build script and included so that `scl bench` remains a single file.
const PROGRAM: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/lossless_publisher"));

/// Starts the publisher on the core of this process, which waits while the publisher sends. Returns when it listens.
///
/// It prints a line when a subscriber has connected, then sends one batch for each [`trigger`](Worker::trigger).
pub(crate) async fn start_lossless_publisher(
    paths: &SocketPaths,
    socket: &str,
    message_size: usize,
    batch: usize,
) -> scl::Result<Worker> {
    let program = paths.path("program");
    fs::write(&program, PROGRAM)?;
    fs::set_permissions(&program, fs::Permissions::from_mode(0o700))?;
    let mut command = Command::new(program);
    command.arg(paths.endpoint(socket)).args([message_size.to_string(), batch.to_string()]);
    let mut publisher = Worker::spawn(command)?;
    let _listening = publisher.next_line().await?;
    Ok(publisher)
}
