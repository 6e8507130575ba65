//! A transport that tells the model what crosses the border between gates and transport.

use super::layout::ENDPOINTS;
use super::message::Message;
use super::model::Model;
use bytes::Bytes;
use scl::transport::{Answerer, Asker, Inlet, Outlet, Transport, TransportError};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard};
use std::task::{Context, Poll};

/// The model, which the ends of the ledger and the stage share.
#[derive(Clone)]
pub(super) struct Book(Arc<Mutex<Model>>);

impl Book {
    pub(super) fn new(model: Model) -> Self {
        Self(Arc::new(Mutex::new(model)))
    }

    pub(super) fn model(&self) -> MutexGuard<'_, Model> {
        self.0.lock().unwrap()
    }
}

pub(super) struct Ledger<T> {
    pub(super) transport: T,
    pub(super) book: Book,
}

impl<T> Ledger<T> {
    fn outlet(&self, endpoint: &str, outlet: Box<dyn Outlet>) -> Box<dyn Outlet> {
        match place_of(endpoint) {
            Some(place) => Box::new(Watched { end: outlet, place, book: self.book.clone() }),
            // The tap, which nobody listens to.
            None => outlet,
        }
    }

    fn inlet(&self, endpoint: &str, inlet: Box<dyn Inlet>) -> Box<dyn Inlet> {
        match place_of(endpoint) {
            Some(place) => Box::new(Watched { end: inlet, place, book: self.book.clone() }),
            None => inlet,
        }
    }
}

fn place_of(endpoint: &str) -> Option<usize> {
    ENDPOINTS.iter().position(|known| *known == endpoint)
}

impl<T: Transport> Transport for Ledger<T> {
    fn publish(&self, endpoint: &str) -> Result<Box<dyn Outlet>, TransportError> {
        Ok(self.outlet(endpoint, self.transport.publish(endpoint)?))
    }

    fn subscribe(&self, endpoint: &str) -> Result<Box<dyn Inlet>, TransportError> {
        Ok(self.inlet(endpoint, self.transport.subscribe(endpoint)?))
    }

    fn push(&self, endpoint: &str) -> Result<Box<dyn Outlet>, TransportError> {
        Ok(self.outlet(endpoint, self.transport.push(endpoint)?))
    }

    fn pull(&self, endpoint: &str) -> Result<Box<dyn Inlet>, TransportError> {
        Ok(self.inlet(endpoint, self.transport.pull(endpoint)?))
    }

    fn request(&self, endpoint: &str) -> Result<Box<dyn Asker>, TransportError> {
        self.transport.request(endpoint)
    }

    fn reply(&self, endpoint: &str) -> Result<Box<dyn Answerer>, TransportError> {
        self.transport.reply(endpoint)
    }
}

/// An end at one of the places.
struct Watched<E> {
    end: E,
    place: usize,
    book: Book,
}

impl Outlet for Watched<Box<dyn Outlet>> {
    fn drive(&mut self, cx: &mut Context<'_>) -> bool {
        let present = self.end.drive(cx);
        self.book.model().sender_learns(self.place, present);
        present
    }

    fn offer(&mut self, cx: &mut Context<'_>, message: Bytes) -> Result<(), Bytes> {
        let read = Message::read(&message);
        let taken = self.end.offer(cx, message);
        let mut model = self.book.model();
        match read {
            Ok(message) => model.offered(self.place, message, taken.is_ok()),
            Err(reason) => model.is_no_message(self.place, reason),
        }
        taken
    }

    fn offer_all(&mut self, cx: &mut Context<'_>, queue: &mut VecDeque<Bytes>, taken: &mut dyn FnMut(usize)) {
        let mut offered: VecDeque<Bytes> = queue.clone();
        let mut count = 0;
        self.end.offer_all(cx, queue, &mut |length| {
            count += 1;
            taken(length);
        });
        offered.truncate(count + 1);
        let mut model = self.book.model();
        for (place, frame) in offered.iter().enumerate() {
            match Message::read(frame) {
                Ok(message) => model.offered(self.place, message, place < count),
                Err(reason) => model.is_no_message(self.place, reason),
            }
        }
    }

    fn is_flushed(&self) -> bool {
        self.end.is_flushed()
    }
}

impl Inlet for Watched<Box<dyn Inlet>> {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        let polled = self.end.poll_recv(cx);
        if let Poll::Ready(frame) = &polled {
            let mut model = self.book.model();
            match Message::read(frame) {
                Ok(message) => model.arrives(self.place, message),
                Err(reason) => model.is_no_message(self.place, reason),
            }
        }
        polled
    }

    fn peers(&self) -> Option<usize> {
        self.end.peers()
    }

    fn malformed(&self) -> u64 {
        self.end.malformed()
    }
}
