//! ZeroMQ, over Unix sockets or loopback TCP: ZMTP 3.0 in all six roles.
//!
//! | role | socket | peers | file |
//! |---|---|---|---|
//! | publish | XPUB, accepts | SUB, XSUB | `publish.rs`, `subscribers.rs`, `link.rs` |
//! | subscribe | SUB, connects | PUB, XPUB | `subscribe.rs`, `inbound.rs` |
//! | push | PUSH, connects | PULL | `push.rs`, `link.rs` |
//! | pull | PULL, accepts | PUSH | `pull.rs`, `inbound.rs` |
//! | request | DEALER, connects | REP, ROUTER | `request.rs` |
//! | reply | ROUTER, accepts | REQ, DEALER | `reply.rs` |
//!
//! `zmtp` is the protocol without I/O, `session.rs` a stream that speaks it; `acceptor.rs` and `dialler.rs` make
//! connections. SCL's ends recognize each other by a property of READY and grant each other credit; plain ZeroMQ
//! programs see none of that. `docs/zeromq.md` describes it exactly.

mod acceptor;
mod burst;
mod catch_up;
mod credit;
mod dialler;
mod inbound;
mod link;
mod listener;
mod memory_format;
mod publish;
mod pull;
mod push;
mod refusals;
mod reply;
mod request;
mod session;
mod shared_memory;
mod stream;
mod subscribe;
mod subscribers;
mod tap;
mod tap_reader;
mod tcp_user;
#[cfg(test)]
mod tests;
mod timer;
mod topics;
mod waiting_report;
mod zmtp;

use super::{Endpoint, Guarantees, Receiver, Replier, Requester, Sender, Tap, Transport, TransportError};
use crate::runtime_dir::SystemDir;
use std::sync::Arc;

#[doc(hidden)]
pub use zmtp::decode_for_fuzzing;

pub use crate::transport_kind::TransportKind;
pub(crate) use tap_reader::TapReader;

/// The transport between programs.
pub struct ZeroMq {
    dir: Arc<SystemDir>,
    kind: TransportKind,
}

impl ZeroMq {
    /// Creates a transport whose ends meet in a system's folder.
    pub fn new(dir: SystemDir, kind: TransportKind) -> Self {
        Self { dir: Arc::new(dir), kind }
    }
}

/// Its guarantees are those of connections between SCL's ends; plain ZeroMQ programs acknowledge nothing.
impl Transport for ZeroMq {
    fn guarantees(&self) -> Guarantees {
        Guarantees::ALL
    }

    fn publish(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        Ok(Box::new(publish::Publisher::open(&self.dir, self.kind, endpoint)?))
    }

    fn subscribe(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        Ok(Box::new(subscribe::Subscriber::open(&self.dir, endpoint)))
    }

    fn push(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        Ok(Box::new(push::Pusher::open(&self.dir, endpoint)))
    }

    fn pull(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        Ok(Box::new(pull::Puller::open(&self.dir, self.kind, endpoint)?))
    }

    fn request(&self, endpoint: &Endpoint) -> Result<Box<dyn Requester>, TransportError> {
        Ok(Box::new(request::Caller::open(&self.dir, endpoint)))
    }

    fn reply(&self, endpoint: &Endpoint) -> Result<Box<dyn Replier>, TransportError> {
        Ok(Box::new(reply::ReplyingEnd::open(&self.dir, self.kind, endpoint)?))
    }

    fn tap(&self, endpoint: &Endpoint) -> Result<Option<Box<dyn Tap>>, TransportError> {
        Ok(Some(Box::new(tap::Tap::open(&self.dir, self.kind, endpoint)?)))
    }
}
