//! ZeroMQ, over Unix sockets or loopback TCP, by the pure-Rust `zeromq` library in all roles but one.
//!
//! The library leaves much open that SCL promises; each file here hides what concerns its role, and says how:
//!
//! | role | socket | what the library lacks |
//! |---|---|---|
//! | publish | an end of our own, one a connection | too much for a way around it (`publish.rs`, `subscriber.rs`, `zmtp.rs`) |
//! | subscribe | SUB, one a publisher | reconnecting backs off to 30 s (`line.rs`) |
//! | push | PUSH | 100,000 messages of its own queue, a lost peer unnoticed (`push.rs`) |
//! | pull | PULL | connections that outlive their socket (`latecomers.rs`) |
//! | request | DEALER with an id frame | REQ never recovers from a restarted peer (`request.rs`) |
//! | reply | ROUTER | the same, and a socket that lives as long as any unanswered request (`reply.rs`) |
//! | all that listen | | spinning when no descriptors are left (`door.rs`) |

mod dial;
mod door;
mod frames;
mod latecomers;
mod line;
mod listen;
mod publish;
mod pull;
mod push;
mod reply;
mod request;
mod stream;
mod subscribe;
mod subscriber;
mod zmtp;

use super::{Answerer, Asker, Inlet, Outlet, Transport, TransportError};
use crate::place::SystemDir;
use std::sync::Arc;
use tokio::runtime::RuntimeFlavor;

/// How the listening ends listen; connecting ends find either.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Medium {
    /// Unix sockets in the runtime folder.
    #[default]
    Ipc,
    /// TCP on 127.0.0.1, the port told in the runtime folder.
    Tcp,
}

/// The transport over the `zeromq` library.
pub struct ZeroMq {
    place: Arc<SystemDir>,
    medium: Medium,
}

impl ZeroMq {
    /// Ends that meet in a system's folder.
    pub fn new(place: SystemDir, medium: Medium) -> Self {
        Self { place: Arc::new(place), medium }
    }
}

impl Transport for ZeroMq {
    fn publish(&self, endpoint: &str) -> Result<Box<dyn Outlet>, TransportError> {
        Ok(Box::new(publish::Publishing::open(&self.place, self.medium, endpoint)?))
    }

    fn subscribe(&self, endpoint: &str) -> Result<Box<dyn Inlet>, TransportError> {
        Ok(Box::new(subscribe::Subscribing::open(&self.place, endpoint)))
    }

    fn push(&self, endpoint: &str) -> Result<Box<dyn Outlet>, TransportError> {
        Ok(Box::new(push::Pushing::open(&self.place, endpoint)))
    }

    fn pull(&self, endpoint: &str) -> Result<Box<dyn Inlet>, TransportError> {
        refuse_several_threads(endpoint)?;
        Ok(Box::new(pull::Pulling::open(&self.place, self.medium, endpoint)?))
    }

    fn request(&self, endpoint: &str) -> Result<Box<dyn Asker>, TransportError> {
        Ok(Box::new(request::Requesting::open(&self.place, endpoint)))
    }

    fn reply(&self, endpoint: &str) -> Result<Box<dyn Answerer>, TransportError> {
        refuse_several_threads(endpoint)?;
        Ok(Box::new(reply::Replying::open(&self.place, self.medium, endpoint)?))
    }
}

/// An end of the library that listens may block the threads of such a runtime for ever as peers connect; better to say so
/// at once than to hang one day.
fn refuse_several_threads(endpoint: &str) -> Result<(), TransportError> {
    let here = tokio::runtime::Handle::try_current();
    if here.is_ok_and(|runtime| runtime.runtime_flavor() != RuntimeFlavor::CurrentThread) {
        return Err(TransportError::SeveralThreads { endpoint: endpoint.to_owned() });
    }
    Ok(())
}
