//! A transport whose replier is connected and accepts no request.

use bytes::Bytes;
use scl::transport::{Answer, Endpoint, Guarantees, Receiver, Replier, Requester, Sender, Transport, TransportError};
use std::task::{Context, Poll};

pub(super) struct Refusing;

struct RefusingRequester;

impl Requester for RefusingRequester {
    fn poll_connected(&mut self, _cx: &mut Context<'_>) -> Poll<()> {
        Poll::Ready(())
    }

    fn request(&mut self, _cx: &mut Context<'_>, _id: u64, body: Bytes) -> Result<(), Bytes> {
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
    fn guarantees(&self) -> Guarantees {
        Guarantees::ALL
    }

    fn publish(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        Err(refused(endpoint))
    }

    fn subscribe(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        Err(refused(endpoint))
    }

    fn push(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        Err(refused(endpoint))
    }

    fn pull(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        Err(refused(endpoint))
    }

    fn request(&self, _endpoint: &Endpoint) -> Result<Box<dyn Requester>, TransportError> {
        Ok(Box::new(RefusingRequester))
    }

    fn reply(&self, endpoint: &Endpoint) -> Result<Box<dyn Replier>, TransportError> {
        Err(refused(endpoint))
    }
}

fn refused(endpoint: &Endpoint) -> TransportError {
    TransportError::Refused {
        endpoint: endpoint.name.to_string(),
        reason: "this transport has only requesters".to_owned(),
    }
}
