//! Endpoints by name: one end listens, any number join, in any order; each pair gets a connection.

use super::pipe::{keep, wake};
use crate::sync::lock;
use crate::transport::TransportError;
use std::collections::HashMap;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};

/// The endpoints of one kind. `L` is what a connection is to the end that listens, `J` to one that joined.
pub(super) struct Meeting<L, J> {
    endpoints: Arc<Mutex<Endpoints<L, J>>>,
    connect: fn() -> (L, J),
}

type Endpoints<L, J> = HashMap<String, Endpoint<L, J>>;

struct Endpoint<L, J> {
    listening: Option<Arc<Inbox<L>>>,
    joined: Vec<Arc<Inbox<J>>>,
}

impl<L, J> Meeting<L, J> {
    pub(super) fn new(connect: fn() -> (L, J)) -> Self {
        Self { endpoints: Arc::default(), connect }
    }

    /// Listens at an endpoint: connects to those who joined it, and from now on to those who do.
    pub(super) fn listen(&self, name: &str) -> Result<Present<L, J, L>, TransportError> {
        let inbox = Arc::new(Inbox::default());
        let mut endpoints = lock(&self.endpoints);
        let endpoint = endpoints.entry(name.to_owned()).or_default();
        if endpoint.listening.is_some() {
            let reason = "another component of this program listens there; open each component once in a place";
            return Err(TransportError::Refused { endpoint: name.to_owned(), reason: reason.to_owned() });
        }
        endpoint.listening = Some(Arc::clone(&inbox));
        let woken: Vec<_> = endpoint.joined.iter().flat_map(|joined| self.introduce(&inbox, joined)).collect();
        drop(endpoints);
        woken.into_iter().for_each(wake);
        Ok(self.present(name, inbox))
    }

    /// Joins an endpoint: connects to whoever listens there, and again to whoever does after that.
    pub(super) fn join(&self, name: &str) -> Present<L, J, J> {
        let inbox = Arc::new(Inbox::default());
        let mut endpoints = lock(&self.endpoints);
        let endpoint = endpoints.entry(name.to_owned()).or_default();
        endpoint.joined.push(Arc::clone(&inbox));
        let woken = endpoint.listening.as_ref().map(|listening| self.introduce(listening, &inbox));
        drop(endpoints);
        woken.into_iter().flatten().for_each(wake);
        self.present(name, inbox)
    }

    /// Connects two ends; whom to wake about it.
    fn introduce(&self, listening: &Inbox<L>, joined: &Inbox<J>) -> [Option<Waker>; 2] {
        let (listeners, joiners) = (self.connect)();
        [listening.put(listeners), joined.put(joiners)]
    }

    fn present<H>(&self, name: &str, inbox: Arc<Inbox<H>>) -> Present<L, J, H> {
        Present { endpoints: Arc::clone(&self.endpoints), name: name.to_owned(), inbox }
    }
}

/// An end's presence at its endpoint, until it is dropped. `H` is what connections are to this end.
pub(super) struct Present<L, J, H> {
    endpoints: Arc<Mutex<Endpoints<L, J>>>,
    name: String,
    inbox: Arc<Inbox<H>>,
}

impl<L, J, H> Present<L, J, H> {
    /// The next new connection.
    pub(super) fn poll_connection(&self, cx: &Context<'_>) -> Poll<H> {
        let mut arrivals = lock(&self.inbox.arrivals);
        if arrivals.connections.is_empty() {
            keep(&mut arrivals.waiting, cx);
            return Poll::Pending;
        }
        Poll::Ready(arrivals.connections.remove(0))
    }

    /// Whether there is a new connection of some kind.
    pub(super) fn has_connection(&self, of_kind: impl Fn(&H) -> bool) -> bool {
        lock(&self.inbox.arrivals).connections.iter().any(of_kind)
    }
}

impl<L, J, H> Drop for Present<L, J, H> {
    fn drop(&mut self) {
        let mut endpoints = lock(&self.endpoints);
        let Some(endpoint) = endpoints.get_mut(&self.name) else { return };
        let own = Arc::as_ptr(&self.inbox).cast::<()>();
        endpoint.joined.retain(|joined| Arc::as_ptr(joined).cast() != own);
        if endpoint.listening.as_ref().is_some_and(|listening| Arc::as_ptr(listening).cast() == own) {
            endpoint.listening = None;
        }
        if endpoint.listening.is_none() && endpoint.joined.is_empty() {
            endpoints.remove(&self.name);
        }
    }
}

/// New connections that an end has not looked at yet.
struct Inbox<H> {
    arrivals: Mutex<Arrivals<H>>,
}

struct Arrivals<H> {
    connections: Vec<H>,
    waiting: Option<Waker>,
}

impl<H> Inbox<H> {
    fn put(&self, connection: H) -> Option<Waker> {
        let mut arrivals = lock(&self.arrivals);
        arrivals.connections.push(connection);
        arrivals.waiting.take()
    }
}

impl<H> Default for Inbox<H> {
    fn default() -> Self {
        Self { arrivals: Mutex::new(Arrivals { connections: Vec::new(), waiting: None }) }
    }
}

impl<L, J> Default for Endpoint<L, J> {
    fn default() -> Self {
        Self { listening: None, joined: Vec::new() }
    }
}
