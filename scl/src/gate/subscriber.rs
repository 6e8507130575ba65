//! The `sub` gate.

use super::GateStats;
use super::incoming::Incoming;
use super::receiving_gate::receiving_gate;
#[cfg(feature = "raw")]
use super::view::View;
use crate::error::{OpenError, RecvError, RecvTimeoutError};
use crate::senders::{Senders, senders};
use crate::spec::ConnectionSpec;
use std::time::Duration;

/// Receives messages from one or several publishers, in order of arrival.
///
/// It connects to publishers that start later, and reconnects to those that restart.
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
///
/// `S` is the enum of its senders, if a program has to tell several apart, see [`recv_from`](Self::recv_from).
pub struct Sub<T, S = ()> {
    pub(crate) incoming: Incoming<T>,
    /// In the order of the connections; empty without an enum.
    senders: Box<[S]>,
}

impl<T> Sub<T> {
    pub(crate) fn new(incoming: Incoming<T>) -> Self {
        Self { incoming, senders: Box::new([]) }
    }

    /// The same gate, which tells its senders apart. Only generated code calls it.
    #[doc(hidden)]
    pub fn with_senders<S: Senders>(self) -> Result<Sub<T, S>, OpenError> {
        let (component, spec) = (self.incoming.state.spec.name, self.incoming.spec);
        Ok(Sub { senders: senders(component, spec)?, incoming: self.incoming })
    }
}

impl<T, S: Senders> Sub<T, S> {
    /// [`recv`](Self::recv) that also returns who sent the message: its connection tells, so nothing is added to the
    /// message. Only a gate with several peers has this method.
    ///
    /// If all peers are components of one kind, and each sends to this gate with one of its gates, `S` is the enum of
    /// the kind. Otherwise it is an enum of the gate's own, `ControllerStatesSender`, with a variant for each component
    /// that sends; a component that sends with several gates has one for each, `GpsFix` and `GpsError`.
    ///
    /// ```no_run
    /// scl::topology!("doc/motors.yaml");
    ///
    /// #[scl::main]
    /// async fn main(mut controller: Controller) -> scl::Result<()> {
    ///     loop {
    ///         let (motor, state) = controller.states.recv_from().await?;
    ///         match motor {
    ///             MotorInstance::LeftMotor => println!("left: {state} rad/s"),
    ///             MotorInstance::RightMotor => println!("right: {state} rad/s"),
    ///         }
    ///     }
    /// }
    /// ```
    ///
    /// In a unit test, the counterpart sends for all peers, and the sender is the first of them.
    ///
    /// # Errors
    /// Those of `recv`.
    ///
    /// # Cancel safety
    /// Cancel safe: no message is lost if this is dropped before it is ready.
    pub async fn recv_from(&mut self) -> Result<(S, T), RecvError> {
        let message = self.incoming.recv().await?;
        Ok((self.last_sender(), message))
    }

    /// [`recv_from`](Self::recv_from) from a plain thread.
    ///
    /// # Errors
    /// Those of `recv_from`, and [`RecvError::Blocking`] inside async code or after a stop request.
    pub fn recv_from_blocking(&mut self) -> Result<(S, T), RecvError> {
        let message = self.incoming.recv_blocking()?;
        Ok((self.last_sender(), message))
    }

    /// Returns who sent the message that the last call returned, whichever call that was: for
    /// [`try_recv`](Self::try_recv), [`latest`](Self::latest), [`recv_timeout`](Self::recv_timeout), views and the
    /// stream. Returns `None` before the first message.
    pub fn sender(&self) -> Option<S> {
        self.incoming.last_connection().map(|_| self.last_sender())
    }

    fn last_sender(&self) -> S {
        self.senders[self.incoming.last_link()]
    }
}

impl<T, S> Sub<T, S> {
    /// Waits for the next message.
    ///
    /// The gate's `queue` applies to what has arrived. With `queue: 1` this is always the newest message, also after a
    /// pause: a sender that may hold a newer one is asked for it.
    ///
    /// # Errors
    /// [`RecvError::Decode`] if the codec cannot read a message and the gate declares `undecodable: fail`; the next
    /// call returns the next message. By default such a message is skipped.
    ///
    /// # Cancel safety
    /// Cancel safe: no message is lost if this is dropped before it is ready.
    pub async fn recv(&mut self) -> Result<T, RecvError> {
        self.incoming.recv().await
    }

    /// [`recv`](Self::recv) from a plain thread.
    ///
    /// # Errors
    /// Those of `recv`, and [`RecvError::Blocking`] inside async code or after a stop request.
    pub fn recv_blocking(&mut self) -> Result<T, RecvError> {
        self.incoming.recv_blocking()
    }

    /// [`recv_blocking`](Self::recv_blocking) with a time limit.
    ///
    /// # Errors
    /// Those of `recv_blocking`, and [`RecvTimeoutError::Timeout`] if no message arrived in time.
    pub fn recv_timeout(&mut self, timeout: Duration) -> Result<T, RecvTimeoutError> {
        self.incoming.recv_timeout(timeout)
    }

    /// Returns the next message if one has arrived.
    ///
    /// It does not wait for new messages. Only at a gate with `queue: 1`, after a pause, it may take up to 10 ms
    /// (usually some microseconds) to fetch a newer message that the sender holds back.
    ///
    /// # Errors
    /// Those of `recv`, and [`RecvError::Blocking`] after a stop request.
    pub fn try_recv(&mut self) -> Result<Option<T>, RecvError> {
        self.incoming.try_recv()
    }

    /// Returns the newest message that has arrived and can be decoded, if any, and discards the older ones. It waits no
    /// longer than [`try_recv`](Self::try_recv).
    ///
    /// # Errors
    /// Those of `try_recv`.
    pub fn latest(&mut self) -> Result<Option<T>, RecvError> {
        self.incoming.latest()
    }

    /// Waits until the gate has missed a message: its `deadline` has passed without one. Returns how many it has missed
    /// since the last time, of all senders together, see [`GateStats::missed`]. Each is told once, here or by
    /// [`take_missed`](Self::take_missed).
    ///
    /// ```no_run
    /// scl::topology!("doc/rover.yaml");
    ///
    /// #[scl::main]
    /// async fn main(mut controller: Controller) -> scl::Result<()> {
    ///     loop {
    ///         tokio::select! {
    ///             missed = controller.sensor.deadline_missed() => println!("stop: {} missed", missed?),
    ///             measurement = controller.sensor.recv() => println!("{} m/s", measurement?.speed),
    ///         }
    ///     }
    /// }
    /// ```
    ///
    /// The future does not borrow the gate, which can receive meanwhile, and does not keep the component open. Make it
    /// before that of `recv`, which borrows the gate.
    ///
    /// While it waits it has a timer of the operating system, so a loop with hundreds of rounds a second keeps it from
    /// round to round (`std::pin::pin!`) and makes another one only when it was ready. Real time counts, also in a test
    /// that pauses tokio's clock.
    ///
    /// # Errors
    /// [`RecvError::NoDeadline`] if the gate declares no `deadline`, [`RecvError::Timer`] if the process has no file
    /// descriptor left, and [`RecvError::Blocking`] once the gate or its component is closed.
    ///
    /// # Cancel safety
    /// Cancel safe: what was missed is told by the next call if this is dropped before it is ready.
    pub fn deadline_missed(&self) -> impl Future<Output = Result<u64, RecvError>> + Send + use<T, S> {
        self.incoming.deadline_missed()
    }

    /// Returns how many messages the gate has missed since the last time, and does not wait: for a program without
    /// async. Each is told once, here or by [`deadline_missed`](Self::deadline_missed).
    ///
    /// # Errors
    /// [`RecvError::NoDeadline`] if the gate declares no `deadline`, and [`RecvError::Blocking`] after a stop request.
    pub fn take_missed(&mut self) -> Result<u64, RecvError> {
        self.incoming.take_missed()
    }

    /// Returns how long ago the message that the last call returned was sent, if its publisher has `latched: true` and
    /// sent it before this gate was connected to it. Returns `None` for every message that arrived while connected, and
    /// before the first one.
    ///
    /// The age keeps growing until the next message is received.
    pub fn latched_age(&self) -> Option<Duration> {
        self.incoming.latched_age()
    }

    /// Returns the connection over which the message came that the last call returned; `None` before the first one.
    ///
    /// In a unit test it is the first one. [`sender`](Self::sender) is the same as an enum.
    pub fn last_connection(&self) -> Option<&'static ConnectionSpec> {
        self.incoming.last_connection()
    }

    /// Returns true if all required peers are connected.
    pub fn is_connected(&self) -> bool {
        self.incoming.is_connected()
    }

    /// Returns the gate's counts.
    pub fn stats(&self) -> GateStats {
        self.incoming.stats()
    }
}

#[cfg(feature = "raw")]
impl<T: zerocopy::FromBytes + zerocopy::KnownLayout + zerocopy::Immutable, S> Sub<T, S> {
    /// Waits for the next message and returns a view of it in the memory in which it arrived, instead of a copy: for
    /// large messages, of a type with `codec: raw`.
    ///
    /// Bytes that are not aligned for the type are copied. Messages in shared memory are always aligned.
    ///
    /// ```no_run
    /// use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};
    ///
    /// #[derive(FromBytes, IntoBytes, KnownLayout, Immutable)]
    /// #[repr(C)]
    /// struct Image {
    ///     pixels: [[u8; 1920]; 1080],
    /// }
    ///
    /// scl::topology!("doc/survey.yaml");
    ///
    /// #[scl::main]
    /// fn main(mut detector: Detector) -> scl::Result<()> {
    ///     loop {
    ///         let image = detector.images.recv_view_blocking()?;
    ///         println!("{} bright pixels", image.pixels.as_flattened().iter().filter(|&&pixel| pixel > 127).count());
    ///     }
    /// }
    /// ```
    ///
    /// # Errors
    /// Those of [`recv`](Self::recv), and [`RecvError::NoViews`] if the gate's codec is not `raw`.
    ///
    /// # Cancel safety
    /// Cancel safe: no message is lost if this is dropped before it is ready.
    pub async fn recv_view(&mut self) -> Result<View<T>, RecvError> {
        self.incoming.recv_view().await
    }

    /// [`recv_view`](Self::recv_view) from a plain thread.
    ///
    /// # Errors
    /// Those of `recv_view`, and [`RecvError::Blocking`] inside async code or after a stop request.
    pub fn recv_view_blocking(&mut self) -> Result<View<T>, RecvError> {
        self.incoming.recv_view_blocking()
    }

    /// Returns a view of the next message if one has arrived. It waits no longer than [`try_recv`](Self::try_recv).
    ///
    /// # Errors
    /// Those of `recv_view`, and [`RecvError::Blocking`] after a stop request.
    pub fn try_recv_view(&mut self) -> Result<Option<View<T>>, RecvError> {
        self.incoming.try_recv_view()
    }
}

receiving_gate!(Sub, S);
