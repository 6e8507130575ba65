//! Gates: the typed ends of connections, as the fields of a component.

mod connection;
mod encoding;
mod exchange;
mod foreign;
mod inbox;
mod incoming;
mod io_waker;
mod outgoing;
mod publisher;
mod puller;
mod pusher;
mod queue;
mod receiving_gate;
mod replier;
mod reply_end;
mod requester;
mod sending_gate;
mod stats;
mod subscriber;
mod tap;
mod watch;

pub(crate) use connection::Connection;
pub(crate) use incoming::Incoming;
pub(crate) use outgoing::Outgoing;
pub use publisher::Pub;
pub use puller::Pull;
pub use pusher::Push;
pub use replier::{Rep, Request};
pub use requester::Req;
pub use stats::{GateStats, PeerStats};
pub use subscriber::Sub;
pub(crate) use tap::GateTap;
pub(crate) use watch::Watch;

use crate::error::Missing;
use crate::spec::GateSpec;

/// What the gates of all kinds have in common. Only SCL's gates implement it.
pub trait AnyGate: sealed::Sealed {
    /// What the topology says about the gate.
    fn spec(&self) -> &'static GateSpec;

    /// The required peers that are not connected. Gates that listen for any number of peers (`rep`, `pull`) have none.
    #[doc(hidden)]
    fn missing(&self) -> Vec<Missing>;

    /// The same, for as long as the gate exists.
    #[doc(hidden)]
    fn watch(&self) -> Watch;
}

mod sealed {
    pub trait Sealed {}
}
