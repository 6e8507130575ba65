//! The listening side of an endpoint: bound safely by [`place`](crate::place), handed to the library.

use super::Medium;
use super::door::Door;
use crate::place::{self, Claim, SystemDir};
use crate::transport::TransportError;
use futures_core::Stream;
use std::pin::Pin;
use std::task::{Context, Poll, Waker};
use zeromq::{Listener, Socket, SocketEvent};

/// A socket that listens, with what removes its endpoint again.
pub(super) struct Listening<S> {
    pub(super) socket: S,
    /// Everything that has happened at the listener since it was handed over.
    pub(super) events: Events,
    pub(super) door: Door,
    pub(super) guard: Claim,
}

/// What the library's monitor tells of a socket.
pub(super) type Events = Pin<Box<dyn Stream<Item = SocketEvent> + Send>>;

/// Binds a fresh socket of the library to an endpoint.
pub(super) fn listen<S: Socket>(
    place: &SystemDir,
    medium: Medium,
    endpoint: &str,
) -> Result<Listening<S>, TransportError> {
    let refused = |reason| TransportError::Refused { endpoint: endpoint.to_owned(), reason };
    let (listener, guard) = bind(place, medium, endpoint)?;
    let door = Door::of(&listener).map_err(|error| refused(error.to_string()))?;
    let mut socket = S::new();
    // Asked for first: with several threads, a peer may be taken in before the library has returned the socket, and it
    // is reported only to those who asked before.
    let events = Box::pin(socket.monitor());
    adopt(&mut socket, listener).map_err(refused)?;
    Ok(Listening { socket, events, door, guard })
}

pub(super) fn bind(place: &SystemDir, medium: Medium, endpoint: &str) -> Result<(Listener, Claim), TransportError> {
    match medium {
        Medium::Ipc => {
            let bound = place::bind_ipc(place, endpoint)?;
            Ok((Listener::from(bound.listener), bound.guard))
        }
        Medium::Tcp => {
            let bound = place::bind_tcp(place, endpoint)?;
            Ok((Listener::from(bound.listener), bound.guard))
        }
    }
}

/// Adopting a bound listener is asynchronous in the library's signature only: it never waits.
fn adopt<S: Socket>(socket: &mut S, listener: Listener) -> Result<(), String> {
    let mut adopting = socket.bind_listener(listener);
    match adopting.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(Ok(_)) => Ok(()),
        Poll::Ready(Err(error)) => Err(error.to_string()),
        Poll::Pending => Err("the library did not take the listener at once".to_owned()),
    }
}
