//! The figures of a gate that tools show, read without borrowing the gate and without waiting for it.

use crate::runtime_dir::GateFigures;
use crate::sync::lock;
use std::sync::Mutex;

/// Brings the figures of a gate up to date, and returns false if the gate was dropped. The connections are those of the
/// plan and never more or fewer. Called twice a second, by a task that no gate may delay and that may delay no gate.
pub(crate) type FigureSource = Box<dyn Fn(&mut GateFigures) -> bool + Send + Sync>;

/// The figures of an end that is locked while a call waits for its socket. They cannot change during the wait.
#[derive(Default)]
pub(crate) struct FiguresInWait(Mutex<InWait>);

#[derive(Default)]
struct InWait {
    is_waiting: bool,
    figures: GateFigures,
}

impl FiguresInWait {
    pub(crate) fn new(connections: usize) -> Self {
        let figures = GateFigures::of_connections(connections);
        Self(Mutex::new(InWait { is_waiting: false, figures }))
    }

    /// Begins a wait: until the returned value is dropped, [`copy_to`](Self::copy_to) copies the figures that `read`
    /// reads now.
    pub(crate) fn begin(&self, read: impl FnOnce(&mut GateFigures)) -> EndOfWait<'_> {
        let mut wait = lock(&self.0);
        read(&mut wait.figures);
        wait.is_waiting = true;
        EndOfWait(self)
    }

    /// Copies the figures of a call that waits; leaves `figures` unchanged if none does.
    pub(crate) fn copy_to(&self, figures: &mut GateFigures) {
        let wait = lock(&self.0);
        if wait.is_waiting {
            figures.copy_from(&wait.figures);
        }
    }
}

pub(crate) struct EndOfWait<'a>(&'a FiguresInWait);

impl Drop for EndOfWait<'_> {
    fn drop(&mut self) {
        lock(&self.0.0).is_waiting = false;
    }
}

impl GateFigures {
    /// Sets everything but the connections, whose memory is kept.
    pub(crate) fn set(&mut self, counts: Self) {
        let connections = std::mem::take(&mut self.connections);
        *self = Self { connections, ..counts };
    }

    fn copy_from(&mut self, other: &Self) {
        let mut connections = std::mem::take(&mut self.connections);
        connections.copy_from_slice(&other.connections);
        *self = Self { connections, ..*other };
    }

    /// Fills in what is known of each connection of a gate whose peers share an endpoint.
    pub(crate) fn share(&mut self) {
        let all = self.connections.len() as u64;
        let of_each = |count: u64| if all == 1 { count } else { 0 };
        let (taken, missed, expired) = (of_each(self.received), of_each(self.missed), of_each(self.expired));
        for connection in &mut self.connections {
            connection.connected = self.peers >= all;
            (connection.taken, connection.missed, connection.expired) = (taken, missed, expired);
        }
    }

    /// Marks the gate as dropped: no peer is connected and no message waits, while all other counts stay.
    pub(crate) fn close(&mut self) {
        (self.peers, self.waiting) = (0, 0);
        for connection in &mut self.connections {
            (connection.connected, connection.waiting) = (false, 0);
        }
    }
}
