//! Plain zenoh as its users write it: two peers that are connected over loopback TCP and discover no others.

use std::fs;
use std::net::TcpListener;
use std::path::Path;
use std::rc::Rc;
use zenoh::bytes::ZBytes;
use zenoh::handlers::FifoChannelHandler;
use zenoh::pubsub::{Publisher, Subscriber};
use zenoh::qos::CongestionControl;
use zenoh::sample::Sample;
use zenoh::{Config, Session, Wait};

/// A peer. Its calls block and must be made outside of an async runtime: zenoh panics in a single-threaded one.
pub(crate) struct Peer(Session);

pub(crate) struct Sending(Publisher<'static>, #[expect(dead_code, reason = "is held")] Rc<Peer>);

pub(crate) struct Receiving(Subscriber<FifoChannelHandler<Sample>>, #[expect(dead_code, reason = "is held")] Rc<Peer>);

impl Peer {
    /// Listens on a port of this machine and writes its number to `file`, or connects to the port whose number `file`
    /// contains.
    pub(crate) fn join(file: &Path, listens: bool) -> scl::Result<Rc<Self>> {
        let port = if listens { free_port()? } else { fs::read_to_string(file)?.parse()? };
        let key = if listens { "listen/endpoints" } else { "connect/endpoints" };
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
        let peer = Self(zenoh::open(config).wait().map_err(as_error)?);
        if listens {
            fs::write(file, port.to_string())?;
        }
        Ok(Rc::new(peer))
    }

    /// Declares a publisher that waits rather than lose a message.
    pub(crate) fn sending(self: &Rc<Self>, key: &str) -> scl::Result<Sending> {
        let publisher = self.0.declare_publisher(key.to_owned()).congestion_control(CongestionControl::Block);
        Ok(Sending(publisher.wait().map_err(as_error)?, Rc::clone(self)))
    }

    pub(crate) fn receiving(self: &Rc<Self>, key: &str) -> scl::Result<Receiving> {
        Ok(Receiving(self.0.declare_subscriber(key.to_owned()).wait().map_err(as_error)?, Rc::clone(self)))
    }
}

impl Sending {
    pub(crate) fn send(&self, payload: impl Into<ZBytes>) -> scl::Result<()> {
        self.0.put(payload).wait().map_err(as_error)
    }

    /// Waits until the other peer subscribes.
    pub(crate) fn wait_for_subscriber(&self) -> scl::Result<()> {
        let listener = self.0.matching_listener().wait().map_err(as_error)?;
        if !self.0.matching_status().wait().map_err(as_error)?.matching() {
            listener.recv().map_err(as_error)?;
        }
        Ok(())
    }
}

impl Receiving {
    /// Waits for the next message.
    pub(crate) fn receive(&self) -> scl::Result<Sample> {
        self.0.recv().map_err(as_error)
    }
}

/// A port of this machine that was free a moment ago.
pub(crate) fn free_port() -> scl::Result<u16> {
    Ok(TcpListener::bind(("127.0.0.1", 0))?.local_addr()?.port())
}

fn as_error(error: zenoh::Error) -> scl::Error {
    scl::Error::message(format!("zenoh: {error}"))
}
