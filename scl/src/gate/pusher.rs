//! The `push` gate.

use super::GateStats;
use super::sending::Sending;
use super::sending_gate::sending_gate;
use crate::error::{SendError, TrySendError};

/// Hands messages to the `pull` gate that this gate is connected to.
///
/// With several pullers (`share: true`) each message goes to one of them, to the next in turn that can take it.
///
/// ```no_run
/// scl::topology!("doc/rover.yaml");
///
/// #[scl::main]
/// async fn main(mut sensor: Sensor) -> scl::Result<()> {
///     sensor.log.send(&rover::Measurement { speed: 1.0 }).await?;
///     Ok(())
/// }
/// ```
pub struct Push<T> {
    pub(super) sending: Sending<T>,
}

impl<T> Push<T> {
    pub(crate) fn new(sending: Sending<T>) -> Self {
        Self { sending }
    }

    /// Sends a message to a puller.
    ///
    /// It returns at once: what a peer cannot take now waits in that connection's queue and follows by itself. Only a
    /// gate with `backpressure: true` waits, for a peer with `when_full: wait` whose queue is full.
    ///
    /// # Errors
    /// [`SendError::Encode`] when the codec cannot express the message; nothing was sent then.
    ///
    /// # Cancel safety
    /// Cancel safe: a message goes to all connections at once, or, if this is dropped while it waits, to none.
    pub async fn send(&mut self, message: &T) -> Result<(), SendError> {
        self.sending.send(message).await
    }

    /// [`send`](Self::send) from a program without async. The message is written before this returns, if the puller is
    /// there and takes it.
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

    /// Waits until a puller has connected or disconnected since this was last called, at first since the gate was
    /// opened, and says how many are connected now. Several changes in a row are reported as one.
    ///
    /// A peer that is killed disconnects as soon as this program notices; one that merely stands still stays connected.
    ///
    /// ```no_run
    /// # scl::topology!("doc/rover.yaml");
    /// # async fn wait(mut sensor: Sensor) {
    /// while sensor.log.peers_changed().await > 0 {}
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

sending_gate!(Push);
