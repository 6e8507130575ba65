//! The side that sends first, and measures.

use crate::components::roundtrip::Requester;
use crate::engines::{NEAR, options};
use crate::link::{CONNECT_TIMEOUT, Near, Setup, connect, open};
use crate::message::Message;
use crate::raw::SocketPaths;
use crate::runtime::run;
use crate::worker::Worker;
use scl::Req;
use scl::bytes::Bytes;
use std::time::Instant;
use tokio::runtime::Runtime;
use zeromq::{DealerSocket, SocketRecv, SocketSend, ZmqMessage};

/// The client of one variant.
pub(super) struct Client<'a> {
    id: &'a str,
    /// Dropped before `end`, which then cleans up for both.
    _echo: Option<Worker>,
    end: End,
}

enum End {
    Published(Box<Near>),
    /// A gate, and whether its calls block.
    Scl(Req<Bytes, Bytes>, bool),
    Zeromq(DealerSocket),
    #[cfg(feature = "libzmq")]
    Libzmq(zmq2::Socket),
}

impl<'a> Client<'a> {
    /// Starts the echo process of a variant and connects to it.
    pub(super) fn start(runtime: &Runtime, id: &'a str, folder: &str, bytes: usize) -> scl::Result<Self> {
        let echo = ["roundtrip", id, folder, &bytes.to_string()];
        let paths = SocketPaths::new(folder, id);
        let is_blocking = id.ends_with("-blocking");
        run(runtime, id, async {
            let (echo, end) = match id {
                "scl-req" | "scl-req-blocking" => {
                    let echo = Worker::start_open(&echo).await?;
                    let requester = connect!(Requester, options(id, folder, NEAR), is_blocking);
                    (Some(echo), End::Scl(requester.request, is_blocking))
                }
                "zeromq-req" => {
                    let echo = Worker::start_open(&echo).await?;
                    (Some(echo), End::Zeromq(paths.connect("request").await?))
                }
                #[cfg(feature = "libzmq")]
                "libzmq-req-blocking" => {
                    let socket = paths.bind_libzmq("request", zmq2::REQ, crate::libzmq::HighWaterMark::Default)?;
                    (Some(Worker::start_open(&echo).await?), End::Libzmq(socket))
                }
                _ => {
                    let setup = Setup { id, folder, bytes, is_round_trip: true, batch: 0 };
                    (None, End::Published(Box::new(Near::open(setup, &echo).await?)))
                }
            };
            Ok(Self { id, _echo: echo, end })
        })
    }

    /// Sends messages one after the other, each when the previous one has returned, and replaces the contents of
    /// `durations` by the round-trip times in nanoseconds.
    pub(super) fn exchange(
        &mut self,
        runtime: &Runtime,
        message: &Message,
        messages: usize,
        durations: &mut Vec<u64>,
    ) -> scl::Result<()> {
        durations.clear();
        run(runtime, self.id, async {
            for _ in 0..messages {
                let started = Instant::now();
                self.end.exchange(message).await?;
                durations.push(started.elapsed().as_nanos().try_into().unwrap_or(u64::MAX));
            }
            Ok(())
        })
    }
}

impl End {
    async fn exchange(&mut self, message: &Message) -> scl::Result<()> {
        match self {
            Self::Published(near) => {
                let (sender, receiver) = near.both()?;
                sender.send(message).await?;
                receiver.receive().await?;
            }
            Self::Scl(gate, true) => drop(gate.call_blocking(&message.payload)?),
            Self::Scl(gate, false) => drop(gate.call(&message.payload).await?),
            Self::Zeromq(dealer) => {
                dealer.send(as_request(&message.payload)).await?;
                dealer.recv().await?;
            }
            #[cfg(feature = "libzmq")]
            Self::Libzmq(socket) => {
                socket.send(&message.payload[..], 0)?;
                socket.recv_msg(0)?;
            }
        }
        Ok(())
    }
}

/// A message as a REQ socket sends it, after an empty frame.
fn as_request(payload: &Bytes) -> ZmqMessage {
    let mut request = ZmqMessage::from(Bytes::new());
    request.push_back(payload.clone());
    request
}
