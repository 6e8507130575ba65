//! Several connections, polled so that none of them keeps the others waiting.

use std::task::Poll;

pub(super) struct RoundRobin<H> {
    pub(super) connections: Vec<H>,
    /// The connection to poll first.
    next: usize,
}

impl<H> RoundRobin<H> {
    pub(super) fn new() -> Self {
        Self { connections: Vec::new(), next: 0 }
    }

    /// Polls each connection once, until one is ready with an item. Drops those that are ready with `None`.
    pub(super) fn poll<M>(&mut self, mut poll: impl FnMut(&mut H) -> Poll<Option<M>>) -> Poll<M> {
        for _ in 0..self.connections.len() {
            if self.next >= self.connections.len() {
                self.next = 0;
            }
            match poll(&mut self.connections[self.next]) {
                Poll::Ready(None) => drop(self.connections.remove(self.next)),
                Poll::Ready(Some(item)) => {
                    self.next += 1;
                    return Poll::Ready(item);
                }
                Poll::Pending => self.next += 1,
            }
        }
        Poll::Pending
    }
}
