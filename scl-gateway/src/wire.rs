//! The wire: everything between two gateways. It knows routes and bytes, but neither components' sockets nor files of
//! the runtime folder.
//!
//! Every handle ([`WireSender`], [`WireReceiver`], [`WireRequester`], [`WireReplier`], [`Announced`]) is `Send` and belongs
//! to one task. Nothing here blocks: commands go through a channel to plain threads, which make all calls of the network
//! library, and events come back through one queue per handle, which wakes the task that polled last. The `poll_*`
//! functions set timers and so need a tokio runtime with time enabled.

mod announcement;
mod error;
mod neighbour;
mod options;
mod receiver;
mod replier;
mod requester;
mod sender;

use std::task::{Context, Poll};

use bytes::Bytes;

pub use self::announcement::Announced;
pub use self::error::WireError;
pub use self::neighbour::Neighbour;
pub use self::options::{Peer, TlsFiles, WireOptions};
pub use self::receiver::{ReceiverEvent, WireReceiver};
pub use self::replier::{ReplierEvent, WireReplier};
pub use self::requester::{RequesterEvent, WireRequester};
pub use self::sender::{SenderEvent, WireSender};
use crate::route::Route;

/// Most messages of one route that are on their way without an acknowledgement; a smaller queue of the receiving gate
/// lowers it.
pub const WINDOW_MESSAGES: u32 = 64;

/// Most bytes of one route that are on their way without an acknowledgement. A larger message travels alone.
pub const WINDOW_BYTES: u64 = 256 * 1024;

/// This host's connection to the gateways of the other hosts.
#[derive(Debug)]
pub struct Wire {}

impl Wire {
    /// Starts listening and connecting. Returns as soon as the listener is bound, whether or not other gateways run.
    ///
    /// # Errors
    ///
    /// Fails if the options contradict each other, without TLS on an address that is not loopback, if a file of the
    /// certificates cannot be used, or if the address is taken. A second gateway of the same host, here or elsewhere, is
    /// found when both are connected to one network: see [`Neighbour::Refused`].
    pub async fn open(options: WireOptions) -> Result<Wire, WireError> {
        let _ = options;
        unimplemented!()
    }

    /// The end at which messages leave this host. It must be `route.from.host`. At most one per route.
    pub fn sender(&self, route: &Route) -> WireSender {
        let _ = route;
        unimplemented!()
    }

    /// The end at which messages arrive at this host. It must be `route.to.host`. At most one per route.
    pub fn receiver(&self, route: &Route) -> WireReceiver {
        let _ = route;
        unimplemented!()
    }

    /// The end at which requests leave this host: the `req` gates are here, the `rep` gate is remote.
    pub fn requester(&self, route: &Route) -> WireRequester {
        let _ = route;
        unimplemented!()
    }

    /// The end at which requests arrive at this host: the `rep` gate is here.
    pub fn replier(&self, route: &Route) -> WireReplier {
        let _ = route;
        unimplemented!()
    }

    /// Tells the other hosts that `component` runs here, until the result is dropped. `content` is its announcement and
    /// schema, up to some MiB, handed to each neighbour as [`Neighbour::Started`].
    pub fn announce(&self, component: &str, content: Bytes) -> Announced {
        let _ = (component, content);
        unimplemented!()
    }

    /// What the other hosts run, and what is wrong with them. Never ends.
    pub fn poll_neighbour(&self, cx: &mut Context<'_>) -> Poll<Neighbour> {
        let _ = cx;
        unimplemented!()
    }

    /// Withdraws everything and closes all connections.
    pub async fn close(self) {}
}
