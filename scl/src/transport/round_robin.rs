//! Several connections, polled so that none of them keeps the others waiting.

use std::task::Poll;

pub(super) struct RoundRobin<H> {
    pub(super) connections: Vec<H>,
    in_a_row: usize,
    /// The connection whose turn it is, and how many items it has delivered in this turn.
    next: usize,
    delivered: usize,
}

impl<H> RoundRobin<H> {
    /// `in_a_row`: how many items one connection may deliver before the next one gets its turn.
    pub(super) fn new(in_a_row: usize) -> Self {
        Self { connections: Vec::new(), in_a_row, next: 0, delivered: 0 }
    }

    /// Returns true if the next poll begins with another connection than the last one.
    pub(super) fn is_turn_over(&self) -> bool {
        self.delivered >= self.in_a_row
    }

    /// Polls each connection once, until one is ready with an item. Drops those that are ready with `None`.
    pub(super) fn poll<M>(&mut self, mut poll: impl FnMut(&mut H) -> Poll<Option<M>>) -> Poll<M> {
        if self.is_turn_over() {
            self.next_turn();
        }
        for _ in 0..self.connections.len() {
            if self.next >= self.connections.len() {
                self.next = 0;
            }
            match poll(&mut self.connections[self.next]) {
                Poll::Ready(None) => drop(self.connections.remove(self.next)),
                Poll::Ready(Some(item)) => {
                    self.delivered += 1;
                    return Poll::Ready(item);
                }
                Poll::Pending => self.next_turn(),
            }
        }
        Poll::Pending
    }

    fn next_turn(&mut self) {
        self.next += 1;
        self.delivered = 0;
    }
}
