//! The peers of an XPUB socket, so that their connections can be closed.
//!
//! The library keeps the connections of an XPUB socket open after the socket is dropped, until the process ends: a
//! component that is closed and opened again in one process would leave its subscribers waiting at the old one. Telling
//! the library that each peer left closes its connection. A peer is taken in a moment before it is reported, so those
//! that are reported after the socket was dropped are waited for.

use super::door::Door;
use super::listen::Events;
use crate::sync::lock;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};
use std::time::Duration;
use tokio::runtime::Handle;
use zeromq::util::PeerIdentity;
use zeromq::{MultiPeerBackend, Socket, SocketEvent};

/// The first pause; each is twice as long as the one before, up to [`LONGEST_PAUSE`], for peers that stay silent.
const FIRST_PAUSE: Duration = Duration::from_millis(1);
const LONGEST_PAUSE: Duration = Duration::from_secs(1);

pub(super) struct Peers {
    book: Arc<Mutex<Book>>,
    runtime: Option<Handle>,
}

struct Book {
    backend: Arc<dyn MultiPeerBackend>,
    events: Events,
    accepted: Vec<PeerIdentity>,
    /// Gone with the socket, so that nobody knocks at a listener that takes nobody in.
    door: Option<Door>,
}

impl Peers {
    pub(super) fn of(socket: &impl Socket, events: Events, door: Door) -> Self {
        let book = Book { backend: socket.backend(), events, accepted: Vec::new(), door: Some(door) };
        Self { book: Arc::new(Mutex::new(book)), runtime: Handle::try_current().ok() }
    }

    /// Takes note of who has connected since.
    pub(super) fn note(&mut self, cx: &mut Context<'_>) {
        lock(&self.book).note(cx);
    }

    /// How many have introduced themselves since all connections were closed, whether they are still there or not.
    pub(super) fn connected(&self) -> usize {
        lock(&self.book).accepted.len()
    }

    /// Closes all connections.
    pub(super) fn close(&mut self) {
        lock(&self.book).close();
    }
}

impl Book {
    fn note(&mut self, cx: &mut Context<'_>) {
        while let Poll::Ready(Some(event)) = self.events.as_mut().poll_next(cx) {
            if let Some(door) = &mut self.door {
                door.heard(&event);
            }
            if let SocketEvent::Accepted(_, peer) = event {
                self.accepted.push(peer);
            }
        }
        if let Some(door) = &mut self.door {
            door.keep(cx);
        }
    }

    fn close(&mut self) {
        for peer in self.accepted.drain(..) {
            self.backend.peer_disconnected(&peer);
        }
    }

    fn close_all(&mut self) {
        self.note(&mut Context::from_waker(Waker::noop()));
        self.close();
    }

    /// Whether a handshake is under way; it holds the backend until its peer was reported.
    fn expects_more(&self) -> bool {
        Arc::strong_count(&self.backend) > 1
    }
}

impl Drop for Peers {
    fn drop(&mut self) {
        lock(&self.book).door = None;
        lock(&self.book).close_all();
        if let Some(runtime) = &self.runtime {
            runtime.spawn(close_latecomers(Arc::clone(&self.book)));
        }
    }
}

async fn close_latecomers(book: Arc<Mutex<Book>>) {
    let mut pause = FIRST_PAUSE;
    while close_and_look(&book) {
        tokio::time::sleep(pause).await;
        pause = LONGEST_PAUSE.min(pause * 2);
    }
}

/// Whether more may come.
fn close_and_look(book: &Mutex<Book>) -> bool {
    let mut book = lock(book);
    // Asked first, because who comes in between is in the book by then.
    let more = book.expects_more();
    book.close_all();
    more
}
