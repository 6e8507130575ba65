//! The `pub` gate.

use super::GateStats;
use super::sending::Sending;
use super::sending_gate::sending_gate;
use crate::error::{SendError, TrySendError};

/// Sends messages to every subscriber of this gate.
///
/// Each subscriber has a connection and a queue of its own: a slow or stopped one does not concern the others, and one
/// that is not there yet gets what waits for it (up to its `queue`) when it first appears.
///
/// ```no_run
/// scl::topology!("doc/rover.yaml");
///
/// #[scl::main]
/// async fn main(mut sensor: Sensor) -> scl::Result<()> {
///     let mut tick = scl::time::interval(std::time::Duration::from_millis(1))?;
///     loop {
///         tick.tick().await;
///         sensor.measurements.send(&rover::Measurement { speed: 1.0 }).await?;
///     }
/// }
/// ```
pub struct Pub<T> {
    pub(super) sending: Sending<T>,
}

impl<T> Pub<T> {
    pub(crate) fn new(sending: Sending<T>) -> Self {
        Self { sending }
    }

    /// Sends a message to every subscriber.
    ///
    /// It returns at once: what a peer cannot take now waits in that connection's queue and follows by itself. Only a
    /// gate with `backpressure: true` waits, for a peer with `when_full: wait` whose queue is full.
    ///
    /// The message is written before this returns. Only in a burst, after 32 messages within a millisecond during which the
    /// program awaited nothing else, those that follow are written together: as soon as it does, or when it sends again
    /// after that millisecond.
    ///
    /// # Errors
    /// [`SendError::Encode`] when the codec cannot express the message; nothing was sent then.
    ///
    /// # Cancel safety
    /// Cancel safe: a message goes to all connections at once, or, if this is dropped while it waits, to none.
    pub async fn send(&mut self, message: &T) -> Result<(), SendError> {
        self.sending.send(message).await
    }

    /// [`send`](Self::send) from a program without async. What is left of a burst is written by the next call, or some
    /// milliseconds after the last one.
    ///
    /// # Errors
    /// Those of `send`, and [`SendError::Blocking`] inside async code, which it would bring to a halt.
    pub fn send_blocking(&mut self, message: &T) -> Result<(), SendError> {
        self.sending.send_blocking(message)
    }

    /// Sends without ever waiting.
    ///
    /// # Errors
    /// [`TrySendError::Full`] where `send` would wait; the message was sent to nobody then.
    pub fn try_send(&mut self, message: &T) -> Result<(), TrySendError> {
        self.sending.try_send(message)
    }

    /// Whether all required peers are connected.
    pub fn connected(&self) -> bool {
        self.sending.missing().is_empty()
    }

    /// Waits until a subscriber has connected or disconnected since this was last called, at first since the gate was
    /// opened, and says how many are connected now. Several changes in a row are reported as one.
    ///
    /// A peer that is killed disconnects as soon as this program notices; one that merely stands still stays connected.
    ///
    /// ```no_run
    /// # scl::topology!("doc/rover.yaml");
    /// # async fn wait(mut sensor: Sensor) {
    /// while sensor.measurements.peers_changed().await > 0 {}
    /// println!("nobody is left");
    /// # }
    /// ```
    ///
    /// # Cancel safety
    /// Cancel safe: a change that was not reported is reported by the next call.
    pub async fn peers_changed(&mut self) -> usize {
        self.sending.peers_changed().await
    }

    /// What this gate has done so far.
    pub fn stats(&self) -> GateStats {
        self.sending.stats()
    }
}

sending_gate!(Pub);
