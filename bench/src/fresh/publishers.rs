//! The publishers of all variants, in this process.

use super::components::Publisher;
use super::{BYTES, VARIANTS};
use crate::clock::now;
use crate::raw::SocketPaths;
use crate::worker::unknown_arguments;
use scl::bytes::{BufMut, Bytes, BytesMut};
use std::time::Duration;
use zeromq::{PubSocket, Socket, SocketSend};

const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

/// One publisher per variant.
pub(super) struct Publishers(Vec<PublisherSocket>);

enum PublisherSocket {
    Scl(Publisher),
    Zeromq(PubSocket),
    #[cfg(feature = "libzmq")]
    Libzmq(zmq2::Socket),
}

impl Publishers {
    pub(super) async fn open(folder: &str) -> scl::Result<Self> {
        let mut publishers = Vec::new();
        for variant in VARIANTS {
            publishers.push(PublisherSocket::open(variant.id, folder).await?);
        }
        Ok(Self(publishers))
    }

    /// Waits for the subscribers of SCL. The other publishers drop values until their subscribers have connected.
    pub(super) async fn ready(&self) -> scl::Result<()> {
        for publisher in &self.0 {
            if let PublisherSocket::Scl(publisher) = publisher {
                publisher.ready(CONNECT_TIMEOUT).await?;
            }
        }
        Ok(())
    }

    /// Publishes one value with every publisher.
    pub(super) async fn send(&mut self) -> scl::Result<()> {
        for publisher in &mut self.0 {
            match publisher {
                PublisherSocket::Scl(publisher) => publisher.position.send(&message()).await?,
                PublisherSocket::Zeromq(socket) => socket.send(message().into()).await?,
                #[cfg(feature = "libzmq")]
                PublisherSocket::Libzmq(socket) => socket.send(&message()[..], 0)?,
            }
        }
        Ok(())
    }
}

impl PublisherSocket {
    async fn open(id: &str, folder: &str) -> scl::Result<Self> {
        let paths = SocketPaths::new(folder, id);
        Ok(match id {
            "scl-recv" | "scl-recv-polled" | "scl-recv-blocking" | "scl-latest" => {
                Self::Scl(Publisher::open_with(scl::OpenOptions::new().runtime_dir(folder).system(id)).await?)
            }
            "zeromq" => {
                // Not XPUB, which waits for a subscriber that does not receive.
                let mut socket = PubSocket::new();
                socket.bind(&paths.endpoint("position")).await?;
                Self::Zeromq(socket)
            }
            #[cfg(feature = "libzmq")]
            "libzmq" => {
                let mark = crate::libzmq::HighWaterMark::Default;
                Self::Libzmq(paths.bind_libzmq(&zmq2::Context::new(), "position", zmq2::PUB, mark)?)
            }
            other => return Err(unknown_arguments(&[other])),
        })
    }
}

/// A value that is sent now.
fn message() -> Bytes {
    let mut message = BytesMut::with_capacity(BYTES);
    message.put_u64(now());
    message.resize(BYTES, 0);
    message.freeze()
}
