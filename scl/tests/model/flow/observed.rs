//! A transport that reports to the model what gates hand to it and get from it.

use super::layout::ENDPOINTS;
use super::message::Message;
use super::model::Model;
use bytes::Bytes;
use scl::transport::{
    Disconnected, Driven, Endpoint, Frame, Guarantees, Link, Loan, Peer, Receiver, Replier, Requester, Resumed, Sender,
    Sent, Tap, Transport, TransportError,
};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard};
use std::task::{Context, Poll};
use std::time::Duration;

/// The model, shared between the stage and the observed ends.
#[derive(Clone)]
pub(super) struct SharedModel(Arc<Mutex<Model>>);

impl SharedModel {
    pub(super) fn new(model: Model) -> Self {
        Self(Arc::new(Mutex::new(model)))
    }

    pub(super) fn lock(&self) -> MutexGuard<'_, Model> {
        self.0.lock().unwrap()
    }
}

pub(super) struct ObservedTransport<T> {
    pub(super) transport: T,
    pub(super) model: SharedModel,
}

impl<T> ObservedTransport<T> {
    fn observed<E>(&self, endpoint: &Endpoint, end: E) -> Observed<E> {
        let reader = ENDPOINTS.iter().position(|known| *known == endpoint.name);
        Observed { end, reader: reader.expect("an endpoint of the layout"), model: self.model.clone() }
    }
}

impl<T: Transport> Transport for ObservedTransport<T> {
    fn guarantees(&self) -> Guarantees {
        self.transport.guarantees()
    }

    fn publish(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        Ok(Box::new(self.observed(endpoint, self.transport.publish(endpoint)?)))
    }

    fn subscribe(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        Ok(Box::new(self.observed(endpoint, self.transport.subscribe(endpoint)?)))
    }

    fn push(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        Ok(Box::new(self.observed(endpoint, self.transport.push(endpoint)?)))
    }

    fn pull(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        Ok(Box::new(self.observed(endpoint, self.transport.pull(endpoint)?)))
    }

    fn request(&self, endpoint: &Endpoint) -> Result<Box<dyn Requester>, TransportError> {
        self.transport.request(endpoint)
    }

    fn reply(&self, endpoint: &Endpoint) -> Result<Box<dyn Replier>, TransportError> {
        self.transport.reply(endpoint)
    }

    fn tap(&self, endpoint: &Endpoint) -> Result<Option<Box<dyn Tap>>, TransportError> {
        self.transport.tap(endpoint)
    }
}

/// An end or link of the connection to one reader.
struct Observed<E> {
    end: E,
    reader: usize,
    model: SharedModel,
}

impl Sender for Observed<Box<dyn Sender>> {
    fn poll_peer(&mut self, cx: &mut Context<'_>) -> Poll<Peer> {
        self.end.poll_peer(cx).map(|Peer { kind, link }| {
            let sender = self.model.lock().link_opens(self.reader);
            let link = Observed { end: link, reader: self.reader, model: self.model.clone() };
            Peer { kind, link: Box::new(ObservedLink { link, sender }) }
        })
    }

    fn refusal(&self) -> Option<String> {
        self.end.refusal()
    }

    fn detach(&mut self) {
        self.end.detach();
    }
}

struct ObservedLink {
    link: Observed<Box<dyn Link>>,
    /// The number of its sender.
    sender: u32,
}

impl Drop for ObservedLink {
    fn drop(&mut self) {
        let Observed { end, reader, model } = &self.link;
        let (unacknowledged, not_received) = (end.unacknowledged(), end.not_received());
        model.lock().link_closes(*reader, self.sender, unacknowledged, not_received);
    }
}

impl Link for ObservedLink {
    fn drive(&mut self, cx: &mut Context<'_>) -> Result<Driven, Disconnected> {
        self.link.end.drive(cx)
    }

    fn send(&mut self, cx: &mut Context<'_>, message: Frame) -> Sent {
        let Observed { end, reader, model } = &mut self.link;
        let frame = message.to_bytes();
        let sent = end.send(cx, message);
        offered(&mut model.lock(), *reader, &frame, matches!(sent, Sent::Sent));
        sent
    }

    fn send_all(
        &mut self,
        cx: &mut Context<'_>,
        driven: Option<Driven>,
        queue: &mut VecDeque<Frame>,
        sent: &mut dyn FnMut(usize),
    ) {
        let Observed { end, reader, model } = &mut self.link;
        let before: Vec<Bytes> = queue.iter().map(Frame::to_bytes).collect();
        end.send_all(cx, driven, queue, sent);
        let (mut model, accepted) = (model.lock(), before.len() - queue.len());
        for (index, frame) in before.iter().take(accepted + 1).enumerate() {
            offered(&mut model, *reader, frame, index < accepted);
        }
        if queue.is_empty() {
            model.is_emptied(*reader);
        }
    }

    fn resumed(&self) -> Option<Resumed> {
        self.link.end.resumed()
    }

    fn loan(&mut self, length: usize) -> Option<Loan> {
        self.link.end.loan(length)
    }

    fn is_written(&self) -> bool {
        self.link.end.is_written()
    }

    fn unacknowledged(&self) -> u64 {
        let Observed { end, reader, model } = &self.link;
        let unacknowledged = end.unacknowledged();
        model.lock().unacknowledged(*reader, unacknowledged);
        unacknowledged
    }

    fn not_received(&self) -> u64 {
        let Observed { end, reader, model } = &self.link;
        let not_received = end.not_received();
        model.lock().not_received(*reader, not_received);
        not_received
    }

    fn read_last(&mut self) {
        self.link.end.read_last();
    }

    fn request_acknowledgement(&mut self, cx: &mut Context<'_>) {
        self.link.end.request_acknowledgement(cx);
    }

    fn detach(&mut self) {
        self.link.end.detach();
    }
}

fn offered(model: &mut Model, reader: usize, frame: &Bytes, accepted: bool) {
    match Message::read(frame) {
        Ok(message) => model.offered(reader, message, accepted),
        Err(reason) => model.is_no_message(reader, reason),
    }
}

impl Receiver for Observed<Box<dyn Receiver>> {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        let polled = self.end.poll_recv(cx);
        if let Poll::Ready(frame) = &polled {
            let mut model = self.model.lock();
            match Message::read(frame) {
                Ok(message) => model.arrives(self.reader, message),
                Err(reason) => model.is_no_message(self.reader, reason),
            }
        }
        polled
    }

    fn peers(&self) -> usize {
        self.end.peers()
    }

    fn malformed(&self) -> u64 {
        self.end.malformed()
    }

    fn note_waiting(&mut self, cx: &mut Context<'_>, waiting: u64) -> bool {
        self.end.note_waiting(cx, waiting)
    }

    fn note_dropped(&mut self) {
        self.end.note_dropped();
    }

    fn acknowledge_last(&mut self) {
        self.end.acknowledge_last();
    }

    fn forget_answers(&mut self) {
        self.end.forget_answers();
    }

    fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        self.end.poll_caught_up(cx)
    }

    fn catch_up(&mut self, within: Duration) {
        self.end.catch_up(within);
    }

    fn refusal(&self) -> Option<String> {
        self.end.refusal()
    }
}
