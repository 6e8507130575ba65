//! Transports: message patterns over opaque frames. A transport knows neither types nor codecs.
//!
//! A transport opens the two ends of each connection; gates own queues, policies and codecs. An implementation of
//! [`Transport`] provides one end per role. Every call on an end returns at once and uses the task's waker to report
//! when it is worth calling again.

mod endpoint;
mod frame;
mod guarantees;
mod heap_memory;
#[cfg(any(feature = "memory", feature = "zeromq"))]
mod link_count;
#[cfg(feature = "memory")]
pub mod memory;
mod receiver;
mod request;
#[cfg(any(feature = "memory", feature = "zeromq"))]
mod round_robin;
mod sender;
#[cfg(any(feature = "memory", feature = "zeromq"))]
mod senders;
#[cfg(feature = "zeromq")]
pub mod zeromq;

pub use endpoint::{Endpoint, PeerCheck, Window};
pub use frame::{Frame, Loan, LoanedMemory};
pub use guarantees::{Guarantee, Guarantees};
pub(crate) use heap_memory::HeapMemory;
pub use receiver::{Receiver, Tap};
pub use request::{Answer, IncomingRequest, Replier, ReplyPath, Requester, RequesterGone};
pub use sender::{Disconnected, Driven, Link, Peer, PeerKind, Resumed, Sender, Sent};

/// Opens the ends of connections.
///
/// Its methods are called inside a tokio runtime of any kind.
pub trait Transport: Send + Sync + 'static {
    /// Returns what this transport promises. Opening a component whose gates need more fails, with an error that names
    /// the gate, its option and the missing guarantee.
    ///
    /// The macro `transport_conformance!` (feature `conformance`) tests what is declared here.
    fn guarantees(&self) -> Guarantees;

    /// Opens the publishing end of one connection. This end listens.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn publish(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError>;

    /// Opens the subscribing end of one connection.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn subscribe(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError>;

    /// Opens a pushing end, which connects to one puller.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn push(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError>;

    /// Opens a pulling end, which listens for any number of pushers.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn pull(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError>;

    /// Opens a requesting end, which connects to one replier.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn request(&self, endpoint: &Endpoint) -> Result<Box<dyn Requester>, TransportError>;

    /// Opens a replying end, which listens for any number of requesters.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn reply(&self, endpoint: &Endpoint) -> Result<Box<dyn Replier>, TransportError>;

    /// Opens a tap, at which tools observe a gate. A transport without taps returns `None`, which is the default.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn tap(&self, endpoint: &Endpoint) -> Result<Option<Box<dyn Tap>>, TransportError> {
        let _no_taps = endpoint;
        Ok(None)
    }
}

/// An end could not be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TransportError {
    /// The endpoint could not be created in the runtime folder.
    #[error(transparent)]
    RuntimeDir(#[from] crate::runtime_dir::RuntimeDirError),
    /// The transport refused to open the endpoint.
    #[error("the transport cannot open `{endpoint}`: {reason}")]
    Refused {
        /// The endpoint's name.
        endpoint: String,
        /// The reason it gave.
        reason: String,
    },
}

impl TransportError {
    #[cfg(any(feature = "memory", feature = "zeromq"))]
    fn refused(endpoint: &str, reason: &dyn std::fmt::Display) -> Self {
        Self::Refused { endpoint: endpoint.to_owned(), reason: reason.to_string() }
    }
}
