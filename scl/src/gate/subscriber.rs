//! The `sub` gate.

use super::GateStats;
use super::incoming::Incoming;
use super::receiving_gate::receiving_gate;
use crate::error::{RecvError, RecvTimeoutError};
use std::time::Duration;

/// Receives messages from one or several publishers, in order of arrival.
///
/// A publisher that starts later or restarts is found by itself.
///
/// ```no_run
/// scl::topology!("doc/rover.yaml");
///
/// #[scl::main]
/// async fn main(mut controller: Controller) -> scl::Result<()> {
///     loop {
///         println!("{} m/s", controller.sensor.recv().await?.speed);
///     }
/// }
/// ```
pub struct Sub<T> {
    pub(super) incoming: Incoming<T>,
}

impl<T> Sub<T> {
    pub(crate) fn new(incoming: Incoming<T>) -> Self {
        Self { incoming }
    }

    /// Waits for the next message.
    ///
    /// The gate's `queue` is applied to what has arrived: with `queue: 1` this is always the newest message.
    ///
    /// # Errors
    /// [`RecvError::Decode`] when a message is not what the codec reads; the next call goes on with the next message.
    ///
    /// # Cancel safety
    /// Cancel safe: no message is lost when this is dropped before it is ready.
    pub async fn recv(&mut self) -> Result<T, RecvError> {
        self.incoming.recv().await
    }

    /// [`recv`](Self::recv) from a program without async.
    ///
    /// # Errors
    /// Those of `recv`, and [`RecvError::Blocking`] inside async code, or when the program was told to stop.
    pub fn recv_blocking(&mut self) -> Result<T, RecvError> {
        self.incoming.recv_blocking()
    }

    /// [`recv_blocking`](Self::recv_blocking), but no longer than a given time.
    ///
    /// # Errors
    /// [`RecvTimeoutError::Timeout`] when nothing arrived in time.
    pub fn recv_timeout(&mut self, timeout: Duration) -> Result<T, RecvTimeoutError> {
        self.incoming.recv_timeout(timeout)
    }

    /// The next message if one has arrived.
    ///
    /// In async code a message is seen to arrive only while the program awaits something now and then.
    ///
    /// # Errors
    /// Those of [`recv_blocking`](Self::recv_blocking).
    pub fn try_recv(&mut self) -> Result<Option<T>, RecvError> {
        self.incoming.try_recv()
    }

    /// The newest message that has arrived, if any; the older ones are passed over.
    ///
    /// # Errors
    /// Those of [`recv_blocking`](Self::recv_blocking).
    pub fn latest(&mut self) -> Result<Option<T>, RecvError> {
        self.incoming.latest()
    }

    /// Whether all required peers are connected.
    pub fn connected(&self) -> bool {
        self.incoming.missing().is_empty()
    }

    /// What this gate has done so far.
    pub fn stats(&self) -> GateStats {
        self.incoming.stats()
    }
}

receiving_gate!(Sub);
