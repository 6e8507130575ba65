//! Sends what a program logs to a gate: to a logger, for example, that every component is connected to.
//!
//! Events are those of the crate [`tracing`], in which programs and libraries, SCL among them, log.
//!
//! ```no_run
//! use tracing::Level;
//!
//! scl::topology!("doc/logger.yaml");
//!
//! #[scl::main]
//! async fn main(sensor: Sensor) -> scl::Result<()> {
//!     scl::events::send(sensor.log, Level::INFO, |event| format!("{} {}", event.level, event.text))?;
//!     tracing::info!(temperature = 21, "ready");
//!     Ok(())
//! }
//! ```
//!
//! `doc/logger.yaml` gives each component the gate `log` with the section `everyone`:
//!
//! ```yaml
#![doc = include_str!("../doc/logger.yaml")]
//! ```
//!
//! A program with a subscriber of its own adds [`layer`] to it.

mod layer;
mod sink;

use crate::gate::{AnyGate, Pub, Push};
use std::error::Error;
use std::fmt;
use std::io;
use std::time::{Duration, SystemTime};
use tracing::Level;

pub use layer::layer;

/// What a program has logged.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Event {
    /// When, by the clock of this machine.
    pub time: SystemTime,
    /// How important it is.
    pub level: Level,
    /// Where in the program, usually the path of a module: `sensor::filter`.
    pub target: &'static str,
    /// The message, then the fields: `ready temperature=21`.
    pub text: String,
}

/// Sends each event of this level, or of a more important one, to a gate, from now on. `message` makes the message.
///
/// The program never waits: a thread makes and sends the messages. If 1,024 events wait for it, or the gate would make
/// it wait, further ones are dropped, and standard error says how many. After a stop request, events are still sent.
/// Events about the gate itself, and those of `message`, are not.
///
/// With several gates, each gets all events.
///
/// # Errors
/// [`SendEventsError::NoLayer`] if the program logs with a subscriber without [`layer`], or with none: with
/// [`main`](macro@crate::main), there is one. [`SendEventsError::Thread`] if the thread cannot be started.
pub fn send<G: EventGate>(
    gate: G,
    level: Level,
    message: impl FnMut(&Event) -> G::Message + Send + 'static,
) -> Result<(), SendEventsError> {
    if !layer::is_installed() {
        return Err(SendEventsError::NoLayer);
    }
    sink::add(gate, level, message).map_err(SendEventsError::Thread)
}

/// Waits until all events so far were handed to their gates. Returns false after `timeout`.
pub fn flush(timeout: Duration) -> bool {
    sink::flush(timeout)
}

/// Does what [`flush`] does, and drops the gates: no later event is sent.
///
/// [`main`](macro@crate::main) does that at its end. Other programs do it before they close the component, which runs
/// until all of its gates are dropped.
pub fn end(timeout: Duration) -> bool {
    sink::end(timeout)
}

/// A gate that events can be sent to: [`Pub`] or [`Push`].
pub trait EventGate: AnyGate + Send + 'static {
    /// What it sends.
    type Message;

    /// The names under which SCL's own events speak of the gate.
    #[doc(hidden)]
    fn names(&self) -> Vec<String>;

    /// Sends a message without waiting; false if it would have to wait, or cannot be sent.
    #[doc(hidden)]
    fn offer(&mut self, message: &Self::Message) -> bool;
}

macro_rules! event_gate {
    ($gate:ident) => {
        impl<T: 'static> EventGate for $gate<T>
        where
            $gate<T>: Send,
        {
            type Message = T;

            fn names(&self) -> Vec<String> {
                self.outgoing.fanout.names()
            }

            fn offer(&mut self, message: &T) -> bool {
                self.outgoing.offer(message).unwrap_or_else(|error| {
                    tracing::warn!("cannot send an event: {error}");
                    false
                })
            }
        }
    };
}

event_gate!(Pub);
event_gate!(Push);

/// Why events cannot be sent.
#[derive(Debug)]
#[non_exhaustive]
pub enum SendEventsError {
    /// The program's log does not have the [`layer`].
    NoLayer,
    /// The thread that sends them could not be started.
    Thread(io::Error),
}

impl fmt::Display for SendEventsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoLayer => f.write_str(
                "events cannot be sent: the program's `tracing` subscriber has no `scl::events::layer()`; add it, or \
                 use `#[scl::main]`",
            ),
            Self::Thread(_) => f.write_str("events cannot be sent: no thread can be started for them"),
        }
    }
}

impl Error for SendEventsError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::NoLayer => None,
            Self::Thread(error) => Some(error),
        }
    }
}
