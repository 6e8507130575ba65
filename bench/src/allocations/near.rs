//! The side whose allocations are counted.

use super::components;
use super::reading::Reading;
use crate::link::{CONNECT_TIMEOUT, Near as UnixNear, Setup, connect, open};
use crate::message::{Frame, Message};
use crate::runtime::run;
use crate::worker::{Worker, unknown_arguments};
use tokio::runtime::Runtime;

/// One role, async or blocking.
pub(super) struct Near {
    role: &'static str,
    is_blocking: bool,
    connection: Connection,
}

enum Connection {
    Scl {
        /// Dropped first.
        _peer: Worker,
        near: Box<components::Near>,
    },
    Unix(Box<UnixNear>, Message),
}

/// Calls a gate in one of two ways.
macro_rules! call {
    ($is_blocking:expr, $gate:expr, $call:ident | $call_blocking:ident ($($argument:expr)?)) => {
        if $is_blocking { $gate.$call_blocking($($argument)?)? } else { $gate.$call($($argument)?).await? }
    };
}

impl Near {
    pub(super) fn open(runtime: &Runtime, role: &'static str, is_blocking: bool, folder: &str) -> scl::Result<Self> {
        run(runtime, calls(is_blocking), async {
            let connection = if role == "unix" {
                let (id, bytes) = (if is_blocking { "unix-blocking" } else { "unix" }, size_of::<Reading>());
                let setup = Setup { id, folder, bytes, is_round_trip: true, batch: 0 };
                let near = UnixNear::open(setup, &["roundtrip", id, folder, &bytes.to_string()]).await?;
                Connection::Unix(Box::new(near), Message::new(bytes))
            } else {
                let peer = Worker::start(&["allocations", role, folder])?;
                let options = scl::OpenOptions::new().runtime_dir(folder).system("allocations");
                Connection::Scl { _peer: peer, near: Box::new(connect!(components::Near, options, is_blocking)) }
            };
            Ok(Self { role, is_blocking, connection })
        })
    }

    /// Plays the role for a number of messages.
    pub(super) fn exchange(&mut self, runtime: &Runtime, messages: usize) -> scl::Result<()> {
        let (role, is_blocking) = (self.role, self.is_blocking);
        run(runtime, calls(is_blocking), async {
            for _ in 0..messages {
                match &mut self.connection {
                    Connection::Scl { near, .. } => exchange(near, role, is_blocking).await?,
                    Connection::Unix(near, message) => {
                        let (sender, receiver) = near.both()?;
                        sender.send(Frame::New(message)).await?;
                        receiver.receive().await?;
                    }
                }
            }
            Ok(())
        })
    }
}

/// How the calls run.
fn calls(is_blocking: bool) -> &'static str {
    if is_blocking { "-blocking" } else { "" }
}

async fn exchange(near: &mut components::Near, role: &str, is_blocking: bool) -> scl::Result<()> {
    let reading = Reading::default();
    match role {
        "publish" => call!(is_blocking, near.publish, send | send_blocking(&reading)),
        "subscribe" => {
            call!(is_blocking, near.subscribe, recv | recv_blocking());
        }
        "push" => call!(is_blocking, near.push, send | send_blocking(&reading)),
        "pull" => {
            call!(is_blocking, near.pull, recv | recv_blocking());
        }
        "request" => {
            call!(is_blocking, near.request, call | call_blocking(&reading));
        }
        "reply" => call!(is_blocking, near.reply, recv | recv_blocking()).reply(&reading)?,
        "publish-and-subscribe" => {
            call!(is_blocking, near.publish, send | send_blocking(&reading));
            call!(is_blocking, near.subscribe, recv | recv_blocking());
        }
        other => return Err(unknown_arguments(&[other])),
    }
    Ok(())
}
