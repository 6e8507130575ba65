//! Plain zenoh as its users write it: two peers that are connected over loopback TCP, and know nobody else.

use std::net::TcpListener;
use zenoh::handlers::FifoChannelHandler;
use zenoh::pubsub::{Publisher, Subscriber};
use zenoh::qos::CongestionControl;
use zenoh::sample::Sample;
use zenoh::{Config, Session, Wait};

/// A peer. Its calls block, and are for threads without an async runtime: zenoh panics on a single-threaded one.
pub(crate) struct Peer(Session);

pub(crate) type Sending = Publisher<'static>;
pub(crate) type Receiving = Subscriber<FifoChannelHandler<Sample>>;

impl Peer {
    /// Listens at `port` of this machine.
    pub(crate) fn listen(port: u16) -> scl::Result<Self> {
        Self::open("listen/endpoints", port)
    }

    /// Connects to the peer that listens at `port`.
    pub(crate) fn connect(port: u16) -> scl::Result<Self> {
        Self::open("connect/endpoints", port)
    }

    fn open(key: &str, port: u16) -> scl::Result<Self> {
        let mut config = Config::default();
        let settings = [
            ("mode", "\"peer\"".to_owned()),
            ("listen/endpoints", "[]".to_owned()),
            (key, format!("[\"tcp/127.0.0.1:{port}\"]")),
            ("scouting/multicast/enabled", "false".to_owned()),
            ("scouting/gossip/enabled", "false".to_owned()),
        ];
        for (key, value) in settings {
            config.insert_json5(key, &value).map_err(as_error)?;
        }
        Ok(Self(zenoh::open(config).wait().map_err(as_error)?))
    }

    /// A publisher that waits rather than lose a message.
    pub(crate) fn sending(&self, key: &str) -> scl::Result<Sending> {
        let publisher = self.0.declare_publisher(key.to_owned()).congestion_control(CongestionControl::Block);
        publisher.wait().map_err(as_error)
    }

    pub(crate) fn receiving(&self, key: &str) -> scl::Result<Receiving> {
        self.0.declare_subscriber(key.to_owned()).wait().map_err(as_error)
    }
}

/// Sends a message.
pub(crate) fn send(publisher: &Sending, payload: impl Into<zenoh::bytes::ZBytes>) -> scl::Result<()> {
    publisher.put(payload).wait().map_err(as_error)
}

/// Waits for the next message.
pub(crate) fn receive(subscriber: &Receiving) -> scl::Result<Sample> {
    subscriber.recv().map_err(as_error)
}

/// Waits until the other peer subscribes.
pub(crate) fn wait_for_subscriber(publisher: &Sending) -> scl::Result<()> {
    let listener = publisher.matching_listener().wait().map_err(as_error)?;
    if publisher.matching_status().wait().map_err(as_error)?.matching() {
        return Ok(());
    }
    listener.recv().map_err(as_error)?;
    Ok(())
}

/// A port of this machine that was free a moment ago.
pub(crate) fn free_port() -> scl::Result<u16> {
    Ok(TcpListener::bind(("127.0.0.1", 0))?.local_addr()?.port())
}

fn as_error(error: zenoh::Error) -> scl::Error {
    scl::Error::message(format!("zenoh: {error}"))
}
