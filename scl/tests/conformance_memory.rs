//! The memory transport keeps every guarantee, and one that declares less keeps those.

use scl::transport::memory::Memory;
use scl::transport::{
    Endpoint, Guarantee, Guarantees, Receiver, Replier, Requester, Sender, Transport, TransportError,
};

mod all {
    scl::transport_conformance!(lends; (scl::transport::memory::Memory::new(), ()));
}

mod some {
    scl::transport_conformance!(lends, only [Acknowledgement, Waiting]; (super::Declared::default(), ()));
}

mod none {
    scl::transport_conformance!(lends, only []; (super::Declared { declares: super::Guarantees::NONE, ..Default::default() }, ()));
}

/// Declares less than it keeps, and refuses requests if it does not declare them.
pub(crate) struct Declared {
    pub(crate) memory: Memory,
    pub(crate) declares: Guarantees,
}

impl Default for Declared {
    fn default() -> Self {
        let declares = [Guarantee::Acknowledgement, Guarantee::Waiting].into_iter().collect();
        Self { memory: Memory::new(), declares }
    }
}

impl Declared {
    fn refused(&self, endpoint: &Endpoint) -> Result<(), TransportError> {
        if self.declares.contains(Guarantee::Requests) {
            return Ok(());
        }
        let reason = "this transport has no requests".to_owned();
        Err(TransportError::Refused { endpoint: endpoint.name.to_string(), reason })
    }
}

impl Transport for Declared {
    fn guarantees(&self) -> Guarantees {
        self.declares
    }

    fn publish(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        self.memory.publish(endpoint)
    }

    fn subscribe(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        self.memory.subscribe(endpoint)
    }

    fn push(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        self.memory.push(endpoint)
    }

    fn pull(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        self.memory.pull(endpoint)
    }

    fn request(&self, endpoint: &Endpoint) -> Result<Box<dyn Requester>, TransportError> {
        self.refused(endpoint)?;
        self.memory.request(endpoint)
    }

    fn reply(&self, endpoint: &Endpoint) -> Result<Box<dyn Replier>, TransportError> {
        self.refused(endpoint)?;
        self.memory.reply(endpoint)
    }
}
