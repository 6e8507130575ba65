//! A transport whose replier is there and takes no request.

use bytes::Bytes;
use scl::transport::{Answer, Answerer, Asker, Inlet, Outlet, Transport, TransportError};
use std::task::{Context, Poll};

pub(super) struct Refusing;

struct Refused;

impl Asker for Refused {
    fn poll_connected(&mut self, _cx: &mut Context<'_>) -> Poll<()> {
        Poll::Ready(())
    }

    fn ask(&mut self, _id: u64, body: Bytes) -> Result<(), Bytes> {
        Err(body)
    }

    fn is_connected(&self) -> bool {
        true
    }

    fn poll_answer(&mut self, _cx: &mut Context<'_>) -> Poll<Answer> {
        Poll::Pending
    }
}

impl Transport for Refusing {
    fn publish(&self, endpoint: &str) -> Result<Box<dyn Outlet>, TransportError> {
        Err(no_end(endpoint))
    }

    fn subscribe(&self, endpoint: &str) -> Result<Box<dyn Inlet>, TransportError> {
        Err(no_end(endpoint))
    }

    fn push(&self, endpoint: &str) -> Result<Box<dyn Outlet>, TransportError> {
        Err(no_end(endpoint))
    }

    fn pull(&self, endpoint: &str) -> Result<Box<dyn Inlet>, TransportError> {
        Err(no_end(endpoint))
    }

    fn request(&self, _endpoint: &str) -> Result<Box<dyn Asker>, TransportError> {
        Ok(Box::new(Refused))
    }

    fn reply(&self, endpoint: &str) -> Result<Box<dyn Answerer>, TransportError> {
        Err(no_end(endpoint))
    }
}

fn no_end(endpoint: &str) -> TransportError {
    TransportError::Refused { endpoint: endpoint.to_owned(), reason: "there are only requests here".to_owned() }
}
